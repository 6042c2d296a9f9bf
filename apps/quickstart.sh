#!/usr/bin/env bash
# From a bare Debian 12 to the figures and the scorecard of Section III and a first look at the whole paper: installs what is missing (as
# root or through sudo), builds the programs, runs them. Stops at the first failure.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

current_step=""
step() {
    current_step="$*"
    printf '\n=== %s (%d s)\n' "$*" "$SECONDS"
}
trap 'echo "quickstart: stopped at: $current_step" >&2' ERR

step "Packages: installing what is missing"
bash apps/install_packages.sh quickstart

step "Build: programs into build/release/bin"
cmake --preset release -DSTOPLINE_BUILD_TESTS=OFF --log-level=WARNING
cmake --build --preset release --target stopline_programs -j "$(nproc)"

step "Single light: seven spacing policies at one traffic light"
build/release/bin/stopline-run scenarios/single_light.yaml --output out/single_light

step "Start-up: the leader's start against the measured one"
build/release/bin/stopline-startup --output out/startup

step "Scorecard: our numbers beside those of the paper, Section III"
verdict=0
build/release/bin/stopline-scorecard --section III || verdict=$?

step "Figures"
find "$PWD/out/single_light" "$PWD/out/startup" \( -name '*.svg' -o -name '*.png' \) | sort

step "The paper: a first look at all sections (some minutes; stopline-reproduce without --quick: all of it)"
report=0
build/release/bin/stopline-reproduce --quick --output out/paper_quick || report=$?

if [[ $verdict != 0 ]]; then
    printf '\nquickstart: done, but the scorecard ended with exit code %d (1: violations in the runs behind it)\n' "$verdict" >&2
fi
if [[ $report != 0 ]]; then
    printf '\nquickstart: done, but the report ended with exit code %d (1: a part failed, see above)\n' "$report" >&2
fi
printf '\n=== Done (%d s). Click or open in a browser:\nfile://%s/out/paper_quick/index.html\n' "$SECONDS" "$PWD"
exit "$((verdict > report ? verdict : report))"
