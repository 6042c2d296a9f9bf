#!/usr/bin/env bash
# Builds Stopline on a bare Debian 12, draws a first figure, and repeats all experiments of the paper in a short
# version. Installs missing packages as root or through sudo. Stops at the first failure.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

current_step=""
step() {
    current_step="$*"
    printf '\n=== %s (%d s)\n' "$*" "$SECONDS"
}
trap 'echo "quickstart: stopped at: $current_step" >&2' ERR

jobs="$(nproc)"
bin=build/release/bin
export NINJA_STATUS="[%f of %t, %e s] "

step "1 of 5: installing missing packages"
bash apps/install_packages.sh quickstart

step "2 of 5: building stopline-run into $bin"
cmake --preset release -DSTOPLINE_BUILD_TESTS=OFF --log-level=WARNING
cmake --build --preset release --target stopline-run -j "$jobs"

step "3 of 5: a queue of 60 vehicles at one traffic light, with seven spacing policies and a mix"
$bin/stopline-run scenarios/single_light.yaml --output out/single_light
printf '\nThe first picture is ready (%d s): vehicles past the stop line over time.\nfile://%s\n' \
    "$SECONDS" "$PWD/out/single_light/counters.svg"

step "4 of 5: building the other programs"
cmake --build --preset release --target stopline_programs -j "$jobs"

step "5 of 5: a first look at all experiments of the paper"
report=0
$bin/stopline-reproduce --quick --output out/paper_quick || report=$?

if [[ $report != 0 ]]; then
    printf '\nquickstart: the report ended with exit code %d (1: a part failed, see above)\n' "$report" >&2
fi
printf '\n=== Done (%d s). Open in a browser:\nfile://%s/out/paper_quick/index.html\n' "$SECONDS" "$PWD"
printf 'Next: README.md, "Your first experiment".\n'
exit "$report"
