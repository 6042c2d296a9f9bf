#!/usr/bin/env bash
# Builds the project and runs its tests, from a bare Debian 12. Missing packages are installed as root or through sudo.
# Stops at the first failure.
#   tests/run.sh           builds the release version and runs its tests and the checks of the sources
#   tests/run.sh --all     adds the slow tests and the fast tests under the address, undefined-behaviour and thread
#                          sanitizers, runs the fuzz targets for some seconds each, and compares the release version
#                          with an unoptimised one
# Three environment variables hold regular expressions for ctest and limit what runs under the sanitizers:
# STOPLINE_ASAN_LABELS (default: unit|threads|cli), STOPLINE_TSAN_LABELS (default: threads) and
# STOPLINE_SANITIZER_EXCLUDE (default: names that begin with Slow, and two suites of statistics, which repeat the same
# code many times). Scripts with the label slow never run under a sanitizer.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

all=no
case "${1:-}" in
    "") ;;
    --quick) echo "tests/run.sh: --quick is the default now" >&2 ;;
    --all) all=yes ;;
    *)
        echo "usage: tests/run.sh [--all]" >&2
        exit 2
        ;;
esac

current_step=""
step() {
    current_step="$*"
    printf '\n=== %s (%d s)\n' "$*" "$SECONDS"
}
trap 'echo "tests/run.sh: stopped at: $current_step" >&2' ERR

jobs="$(nproc)"
slow_names='(^|[./])Slow[A-Z]'  # slow suites and cases of GoogleTest
statistics='^demand\.(PermissiveLeft|WebsterDelay)\.'

# build PRESET TESTS TARGET...: TESTS is ON or OFF and says whether the tests are configured too
build() {
    local preset="$1" tests="$2"
    shift 2
    cmake --preset "$preset" --log-level=WARNING -DSTOPLINE_BUILD_TESTS="$tests"
    cmake --build --preset "$preset" --target "$@" -j "$jobs"
}

# run_fast_tests PRESET LABELS [COMMAND...]: runs the tests fit for a sanitizer; COMMAND is put before ctest
run_fast_tests() {
    local preset="$1" labels="$2"
    shift 2
    "$@" ctest --preset "$preset" -j "$jobs" --label-regex "$labels" \
        --label-exclude slow --exclude-regex "${STOPLINE_SANITIZER_EXCLUDE:-$slow_names|$statistics}" --no-tests=error
}

step "Packages: installing what is missing"
sections=(quickstart tests python)
if [[ $all == yes ]]; then sections+=(sanitizers); fi
bash apps/install_packages.sh "${sections[@]}"
bash tests/tools/install_clang_tidy.sh

step "Release: building programs and tests"
build release ON all

if [[ $all == no ]]; then
    step "Release: tests and checks of the sources, without the slow ones"
    ctest --preset release -j "$jobs" --label-exclude slow --exclude-regex "$slow_names" --no-tests=error
    printf '\n=== Passed (%d s). Slow tests and sanitizers: tests/run.sh --all\n' "$SECONDS"
    exit 0
fi

step "Debug: building stopline-run"
build debug OFF stopline-run

step "Release: all tests and checks of the sources"
STOPLINE_DEBUG_BIN="$PWD/build/debug/bin" ctest --preset release -j "$jobs" --no-tests=error

step "Address and undefined-behaviour sanitizers: building"
build asan-ubsan ON all stopline_fuzz_programs
step "Address and undefined-behaviour sanitizers: fast tests"
export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1
export UBSAN_OPTIONS=print_stacktrace=1
run_fast_tests asan-ubsan "${STOPLINE_ASAN_LABELS:-unit|threads|cli}"

step "Fuzz targets: some seconds each"
bash tests/fuzz/campaign.sh --short build/asan-ubsan

step "Thread sanitizer: building"
build tsan ON stopline_threaded_tests
step "Thread sanitizer: fast tests"
# Archer is the plug-in through which clang's OpenMP runtime informs the thread sanitizer. The runtime itself was not
# built with the sanitizer, so ignore_noninstrumented_modules leaves it out.
export OMP_TOOL_LIBRARIES=/usr/lib/llvm-14/lib/libarcher.so
export TSAN_OPTIONS=ignore_noninstrumented_modules=1
# The thread sanitizer of clang 14 cannot handle the random memory addresses of newer kernels.
fixed_addresses=()
if setarch --addr-no-randomize true 2>/dev/null; then
    fixed_addresses=(setarch --addr-no-randomize)
fi
run_fast_tests tsan "${STOPLINE_TSAN_LABELS:-threads}" "${fixed_addresses[@]}"
printf '\n=== Passed (%d s)\n' "$SECONDS"
