#!/usr/bin/env bash
# Shows that check_includes.py finds what it should: breaks a small tree in each way, one at a time.
set -euo pipefail
check="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/check_includes.py"
tree="$(mktemp -d)"
trap 'rm -rf "$tree"' EXIT

lay_out() {
    rm -rf "${tree:?}"/*
    mkdir -p "$tree"/core/{base,network,vehicle,driver,sim,measure,record,scenario,experiment} "$tree/apps"
    touch "$tree/core/base/units.h" "$tree/core/network/lane.h" "$tree/core/vehicle/engine.h" "$tree/core/sim/events.h"
    printf '#include "base/units.h"\n' >"$tree/core/driver/policy.h"
    printf '#include "network/lane.h"\n#include "sim/events.h"\n' >"$tree/core/measure/zone.h"
    printf '#include <yaml-cpp/yaml.h>\n' >"$tree/core/scenario/read.cpp"
    printf '#include "driver/policy.h"\n#include "vehicle/engine.h"\n' >"$tree/apps/stopline_run.cpp"
}

# expect_problem TEXT: the tree as it is now must fail, with TEXT in the output.
expect_problem() {
    local output
    if output="$(python3 "$check" "$tree")"; then
        echo "not found: $1" >&2
        exit 1
    fi
    if ! grep --quiet --fixed-strings -- "$1" <<<"$output"; then
        printf 'failed without saying "%s":\n%s\n' "$1" "$output" >&2
        exit 1
    fi
    lay_out
}

lay_out
python3 "$check" "$tree" >/dev/null

printf '#include "vehicle/engine.h"\n' >>"$tree/core/driver/policy.h"
expect_problem "core/driver/policy.h:2: driver must not include vehicle/engine.h"
printf '  #  include "driver/policy.h"\n' >"$tree/core/vehicle/engine.h"
expect_problem "vehicle must not include driver/policy.h"
printf '#include "network/lane.h"\n' >"$tree/core/base/units.h"
expect_problem "base must not include network/lane.h"
printf '#include "driver/policy.h"\n' >"$tree/core/measure/zone.h"
expect_problem "measure must not include driver/policy.h"
printf '#include "measure/zone.h"\n' >"$tree/core/sim/events.h"
expect_problem "sim must not include measure/zone.h"
printf '#include "network/lane.h"\n' >"$tree/core/experiment/run.cpp"
expect_problem "experiment must not include network/lane.h"
printf '#include "units.h"\n' >"$tree/core/base/ids.h"
expect_problem "does not begin with a folder of core/"
printf '#include "base/unit.h"\n' >"$tree/core/base/ids.h"
expect_problem "there is no core/base/unit.h"
printf '#include <base/units.h>\n' >"$tree/core/base/ids.h"
expect_problem 'write "base/units.h"'
printf '#include <yaml-cpp/node/node.h>\n' >"$tree/core/scenario/write.cpp"
expect_problem "yaml-cpp belongs in one source file"
mv "$tree/core/scenario/read.cpp" "$tree/core/scenario/read.h"
expect_problem "yaml-cpp belongs in one .cpp of core/scenario"
mkdir "$tree/core/extra" && touch "$tree/core/extra/thing.h"
expect_problem "core/extra is not a known folder"
printf '\n%.0s' {1..451} >"$tree/apps/stopline_run.cpp"
expect_problem "451 lines"
echo "all broken trees were found"
