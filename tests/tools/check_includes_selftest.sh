#!/usr/bin/env bash
# Tests check_includes.py: breaks a small project in one way after another and expects the matching message.
set -euo pipefail
check="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/check_includes.py"
tree="$(mktemp -d)"
trap 'rm -rf "$tree"' EXIT

# lay_out: writes a small project without problems
lay_out() {
    rm -rf "${tree:?}"/*
    mkdir -p "$tree"/core/{base,network,vehicle,driver,sim/state,sim/step,sim/junction,sim/insertion,measure,record,runs} "$tree/apps"
    mkdir -p "$tree"/core/scenario/yaml
    touch "$tree/core/base/units.h" "$tree/core/network/lane.h" "$tree/core/vehicle/engine.h"
    touch "$tree/core/sim/state/events.h" "$tree/core/sim/state/model.h" "$tree/core/sim/junction/stop_lines.h"
    printf '#include "sim/junction/stop_lines.h"\n' >"$tree/core/sim/step/simulation.h"
    printf '#include "base/units.h"\n' >"$tree/core/driver/policy.h"
    printf '#include "network/lane.h"\n#include "sim/state/events.h"\n' >"$tree/core/measure/zone.h"
    printf 'stopline_library(measure PUBLIC stopline_network stopline_sim)\n' >"$tree/core/measure/CMakeLists.txt"
    printf '#include <yaml-cpp/yaml.h>\n' >"$tree/core/scenario/yaml/yaml_source.cpp"
    printf '#include "driver/policy.h"\n#include "vehicle/engine.h"\n' >"$tree/apps/stopline_run.cpp"
}

# expect_problem TEXT: expects the check to fail with TEXT in its output, then restores the project
expect_problem() {
    local output
    if output="$(python3 "$check" "$tree")"; then
        echo "the check did not fail; expected: $1" >&2
        exit 1
    fi
    if ! grep --quiet --fixed-strings -- "$1" <<<"$output"; then
        printf 'the output does not contain "%s":\n%s\n' "$1" "$output" >&2
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
printf '#include "sim/state/model.h"\n' >"$tree/core/measure/zone.h"
expect_problem "measure must not include sim/state/model.h"
printf '#include "measure/zone.h"\n' >"$tree/core/sim/state/events.h"
expect_problem "sim/state must not include measure/zone.h"
printf '#include "sim/junction/stop_lines.h"\n' >"$tree/core/sim/insertion/trips.cpp"
expect_problem "sim/insertion must not include sim/junction/stop_lines.h"
touch "$tree/core/sim/phases.h"
expect_problem "core/sim/phases.h is not a known room"
printf '#include "scenario/load.h"\n' >"$tree/core/record/run.cpp"
expect_problem "record must not include scenario/load.h"
printf '#include "units.h"\n' >"$tree/core/base/ids.h"
expect_problem "does not begin with a folder of core/"
printf '#include "base/unit.h"\n' >"$tree/core/base/ids.h"
expect_problem "there is no core/base/unit.h"
printf '#include <base/units.h>\n' >"$tree/core/base/ids.h"
expect_problem 'write "base/units.h"'
printf '#include <yaml-cpp/node/node.h>\n' >"$tree/core/scenario/write.cpp"
expect_problem "core/scenario/write.cpp:1: <yaml-cpp/node/node.h> is slow to compile"
printf '#include <nlohmann/json.hpp>\n' >"$tree/core/runs/provenance.h"
expect_problem "core/runs/provenance.h:1: <nlohmann/json.hpp> is slow to compile"
printf 'stopline_library(measure PUBLIC stopline_network stopline_sim stopline_driver)\n' >"$tree/core/measure/CMakeLists.txt"
expect_problem "links stopline_driver, but no file of the folder includes it"
printf '#include "sim/step/simulation.h"\n' >"$tree/core/sim/junction/stop_lines.h"
expect_problem "the includes between rooms form a cycle"
mkdir "$tree/core/extra" && touch "$tree/core/extra/thing.h"
expect_problem "core/extra is not a known room"
printf '\n%.0s' {1..451} >"$tree/apps/stopline_run.cpp"
expect_problem "451 lines"
touch "$tree/core/driver/law_"{01..26}.h
expect_problem "27 files in one folder"
echo "all problems were found"
