#!/usr/bin/env bash
# Everything that must hold, from a bare Debian 12: installs what is missing (as root or through sudo), builds, and runs
#   1. the fast tests under the address, undefined-behaviour and thread sanitizers,
#   2. the whole ctest suite on the release build, which also compares it with an unoptimised build.
# Stops at the first failure.
#   tests/run.sh [--quick]           --quick leaves out 1.
# STOPLINE_ASAN_LABELS (default: unit|threads|cli), STOPLINE_TSAN_LABELS (default: threads) and STOPLINE_SANITIZER_EXCLUDE
# (default: Slow), regular expressions for ctest, choose the tests that run under the sanitizers; scripts labelled slow never do.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

quick=no
case "${1:-}" in
    "") ;;
    --quick) quick=yes ;;
    *)
        echo "usage: tests/run.sh [--quick]" >&2
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

# build PRESET TESTS TARGET...: TESTS, ON or OFF, says whether there are targets for tests
build() {
    local preset="$1" tests="$2"
    shift 2
    cmake --preset "$preset" --log-level=WARNING -DSTOPLINE_BUILD_TESTS="$tests"
    cmake --build --preset "$preset" --target "$@" -j "$jobs"
}

# run_fast_tests PRESET LABELS [COMMAND...]: the tests fit for a sanitizer, started through COMMAND
run_fast_tests() {
    local preset="$1" labels="$2"
    shift 2
    "$@" ctest --preset "$preset" -j "$jobs" --label-regex "$labels" \
        --label-exclude slow --exclude-regex "${STOPLINE_SANITIZER_EXCLUDE:-Slow}" --no-tests=error
}

step "Packages: installing what is missing"
bash apps/install_packages.sh quickstart tests
bash tests/tools/install_clang_tidy.sh

step "Release: building programs and tests"
build release ON all

step "Debug: building the programs"
build debug OFF stopline_programs

if [[ $quick == no ]]; then
    step "Address and undefined-behaviour sanitizers: building"
    build asan-ubsan ON all
    step "Address and undefined-behaviour sanitizers: fast tests"
    export ASAN_OPTIONS=detect_stack_use_after_return=1:strict_string_checks=1
    export UBSAN_OPTIONS=print_stacktrace=1
    run_fast_tests asan-ubsan "${STOPLINE_ASAN_LABELS:-unit|threads|cli}"

    step "Thread sanitizer: building"
    build tsan ON stopline_programs stopline_threaded_tests
    step "Thread sanitizer: fast tests"
    # Archer is the plug-in through which clang's OpenMP runtime tells the thread sanitizer of its barriers and joins. The
    # runtime itself, like all libraries of the system, was not built with the sanitizer, so what happens inside it is not
    # looked at: that is what ignore_noninstrumented_modules is for.
    export OMP_TOOL_LIBRARIES=/usr/lib/llvm-14/lib/libarcher.so
    export TSAN_OPTIONS=ignore_noninstrumented_modules=1
    # The sanitizer of clang 14 does not know the address layout that newer kernels randomise to.
    fixed_addresses=()
    if setarch --addr-no-randomize true 2>/dev/null; then
        fixed_addresses=(setarch --addr-no-randomize)
    fi
    run_fast_tests tsan "${STOPLINE_TSAN_LABELS:-threads}" "${fixed_addresses[@]}"
    unset OMP_TOOL_LIBRARIES
fi

step "Release: the whole suite"
STOPLINE_DEBUG_BIN="$PWD/build/debug/bin" ctest --preset release -j "$jobs" --no-tests=error
