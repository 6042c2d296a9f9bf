#!/usr/bin/env bash
# Runs all fuzz targets, one after the other, and ends with a table.
#   tests/fuzz/campaign.sh MINUTES       builds the targets twice and runs all of them for MINUTES in total
#   tests/fuzz/campaign.sh --short BUILD runs each target of a build folder for some seconds, as a test
#
# A campaign uses two builds:
#   fuzz-fast   the code of the programs. An input may take 1 s and 200 MB of memory, all data of libFuzzer included.
#   fuzz        with the address and undefined-behaviour sanitizers. They need several times the time and memory, so
#               the limits are 5 s and 800 MB here. A single allocation may have 200 MB in both builds.
# The builds share one corpus in build/fuzz/corpus, which grows from campaign to campaign. Inputs that break a rule are
# in build/fuzz/findings; copy them to tests/fuzz/corpus/TARGET, where replay_test.cpp reads them in every build.
#
# FUZZ_TARGETS limits a campaign to some targets, as in FUZZ_TARGETS="sumo_net recording".
set -euo pipefail
project="$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)"
cd "$project"

usage() {
    sed -n 's/^#   \(tests.*\)/\1/p' "${BASH_SOURCE[0]}" >&2
    exit 2
}

# Sets max_len, the length of the longest input, in bytes.
set_length() {
    case "$1" in
        quantities) max_len=64 ;;
        formulas) max_len=300 ;;
        overrides) max_len=500 ;;
        scenario | streets | sweep) max_len=6000 ;;
        *) max_len=20000 ;;
    esac
}

# Sets build_limits, the limits on time and memory of an input.
set_limits() {
    if [[ "$1" == *fast* ]]; then
        build_limits=(-timeout=1 -rss_limit_mb=200)
    else
        build_limits=(-timeout=5 -rss_limit_mb=800)
    fi
    build_limits+=(-malloc_limit_mb=200)
}

# value LOG NAME: prints a final statistic of libFuzzer, or 0
value() {
    local found
    found="$(sed -n "s/^stat::$2: *//p" "$1" | tail -1)"
    echo "${found:-0}"
}

# fuzz BUILD TARGET SECONDS CORPUS FINDINGS: adds one line to the table
fuzz() {
    local build="$1" target="$2" seconds="$3" corpus="$4" findings="$5"
    local log dictionary=() stop runs=0 coverage=0 peak=0 spent left number
    log="$(mktemp)"
    mkdir -p "$corpus" "$findings"
    case "$target" in
        scenario | streets | sweep | overrides) dictionary=(-dict="$project/tests/fuzz/dictionaries/yaml.dict") ;;
        sumo_*) dictionary=(-dict="$project/tests/fuzz/dictionaries/sumo.dict") ;;
        quantities | formulas) dictionary=(-dict="$project/tests/fuzz/dictionaries/$target.dict") ;;
        recording) dictionary=(-dict="$project/tests/fuzz/dictionaries/recording.dict") ;;
    esac
    set_limits "$build"
    set_length "$target"
    local begin=$SECONDS
    local begin_mark
    begin_mark="$(mktemp)"
    stop=$((SECONDS + seconds))
    while left=$((stop - SECONDS)) && ((left > 0)); do
        nice -n "$priority" "$build/fuzz/fuzz_$target" -max_total_time="$left" -max_len="$max_len" "${dictionary[@]}" \
            "${build_limits[@]}" -print_final_stats=1 -artifact_prefix="$findings/$target-" -detect_leaks=1 \
            "$corpus" "$build/fuzz/seeds/$target" >"$log" 2>&1 || tail -40 "$log" >>"$findings/$target.log"
        runs=$((runs + $(value "$log" number_of_executed_units)))
        number="$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$log" | tail -1)"
        coverage="${number:-$coverage}"
        number="$(value "$log" peak_rss_mb)"
        if ((number > peak)); then peak="$number"; fi
        if [[ "$(value "$log" number_of_executed_units)" == 0 ]]; then
            cat "$log" >&2
            break
        fi
    done
    spent=$((SECONDS - begin))
    number="$(find "$findings" -name "$target-*" -newer "$begin_mark" | wc -l)"
    printf '%-16s %-10s %13d %8d %10d %10d %8d %9d\n' "$target" "$(basename "$build")" "$runs" "$spent" \
        "$((runs / (spent > 0 ? spent : 1)))" "$coverage" "$peak" "$number" >>"$table"
    rm -f "$log" "$begin_mark"
    all_findings=$((all_findings + number))
}

print_table() {
    printf '%-16s %-10s %13s %8s %10s %10s %8s %9s\n' target build executions seconds per_second coverage peak_MB findings
    cat "$table"
}

export ASAN_OPTIONS=quarantine_size_mb=32:detect_stack_use_after_return=1
export UBSAN_OPTIONS=print_stacktrace=1
all_findings=0
table="$(mktemp)"
work="$(mktemp -d)"
trap 'rm -rf "$table" "$work"' EXIT

if [[ "${1:-}" == --short ]]; then
    priority=0
    [[ $# == 2 && -d "$2/fuzz" ]] || usage
    for program in "$2"/fuzz/fuzz_*; do
        target="${program##*/fuzz_}"
        fuzz "$2" "$target" 4 "$work/corpus/$target" "$work/findings"
    done
    print_table
    if [[ -n "$(find "$work/findings" -type f)" ]]; then
        cat "$work/findings"/*.log >&2
        mkdir -p "$2/fuzz/findings"
        find "$work/findings" -type f -exec cp {} "$2/fuzz/findings" \;
        echo "tests/fuzz/campaign.sh: inputs that break a rule are in $2/fuzz/findings" >&2
        exit 1
    fi
    exit 0
fi

[[ $# == 1 && "$1" =~ ^[0-9]+$ ]] || usage
priority=19
builds=(build/fuzz-fast build/fuzz)
for build in "${builds[@]}"; do
    cmake --preset "$(basename "$build")" --log-level=WARNING
    cmake --build --preset "$(basename "$build")" -j "$(nproc)"
done
read -r -a targets <<<"${FUZZ_TARGETS:-$(find build/fuzz/fuzz -name 'fuzz_*' -printf '%f ' | sed 's/fuzz_//g')}"
seconds=$(($1 * 60 / (${#targets[@]} * ${#builds[@]})))
if ((seconds == 0)); then seconds=1; fi
for target in "${targets[@]}"; do
    for build in "${builds[@]}"; do
        fuzz "$build" "$target" "$seconds" "build/fuzz/corpus/$target" build/fuzz/findings
    done
done
print_table
if ((all_findings > 0)); then
    echo "tests/fuzz/campaign.sh: inputs that break a rule are in build/fuzz/findings" >&2
    exit 1
fi
