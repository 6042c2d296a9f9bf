#!/usr/bin/env bash
# Tests the help of every program, and that wrong usage gives exit code 2 and a message.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
scenario="$STOPLINE_SOURCE/scenarios/first_steps.yaml"

# prints PART... -- COMMAND...: expects exit code 0, nothing on standard error, and each PART on standard output
prints() {
    local parts=()
    while [ "$1" != "--" ]; do
        parts+=("$1")
        shift
    done
    shift
    "$@" >"$work/stdout" 2>"$work/stderr" || fail "$*: exit code $?"
    [ -s "$work/stderr" ] && fail "$*: standard error is not empty: $(head -c 300 "$work/stderr")"
    local part
    for part in "${parts[@]}"; do
        grep -qF -- "$part" "$work/stdout" || fail "$*: '$part' is missing in the output"
    done
}

# refuses PART -- COMMAND...: expects exit code 2, nothing on standard output, and PART in the message
refuses() {
    local part=$1
    shift 2
    local code=0
    (cd "$work" && exec "$@") >"$work/stdout" 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] || fail "$*: exit code $code instead of 2"
    [ -s "$work/stdout" ] && fail "$*: standard output is not empty"
    grep -qF -- "$part" "$work/stderr" || fail "$*: '$part' is missing in: $(head -c 300 "$work/stderr")"
}

run="$STOPLINE_BIN/stopline-run"
scorecard="$STOPLINE_BIN/stopline-scorecard"

strings="$STOPLINE_BIN/stopline-strings"

for program in "$run" "$scorecard" "$STOPLINE_BIN/stopline-calibrate" "$strings"; do
    prints "--help" "--version" "--threads" "--seed" "--output" "Examples:" "Exit codes: 0 done, 1 " -- "$program" --help
    prints "stopline 0." -- "$program" --version
    refuses "--nonsense" -- "$program" --nonsense
    refuses "--threads: value '0' is not allowed; give a whole number from 1 to 1024" -- "$program" --threads 0
    refuses "--threads: value 'two' is not allowed" -- "$program" --threads two
    refuses "--seed" -- "$program" --seed -1
    refuses "--seed" -- "$program" --seed 1.5
    refuses "--seed" -- "$program" --seed 99999999999999999999999
done

prints "signal.green" "km/h" -- "$run" --describe
lists_only() {  # lists_only UNWANTED PART... -- COMMAND...
    unwanted=$1
    shift
    prints "$@"
    if grep -qF -- "$unwanted" "$work/stdout"; then fail "$*: prints '$unwanted'"; fi
}
lists_only "all_red" "signal: " "min_green" -- "$run" --describe green
lists_only "all_red" "signal: " "green" -- "$run" --describe=signal.green
lists_only "standstill_gap" "policies[]: " "time_gap" -- "$run" --describe 'policies[CTG-Ref].time_gap'
lists_only "policies[]: " "all_red" -- "$run" "$scenario" --describe signal
lists_only "all_red" "measure: " "(old name: steady)" -- "$run" --describe measure.steady
refuses "no field has 'signal.gren' in its path; did you mean 'signal.green'?" -- "$run" --describe signal.gren
refuses "no field has 'xyzxyz' in its path (stopline-run --describe lists all fields)" -- "$run" --describe xyzxyz
prints "CDG-6m" "constant_time" "petrol_eu4_72kw" "startup_kit" "three_lanes" -- "$run" --list
for kinds in "grids, streets and imported networks" "single intersections" "single lights"; do
    prints "Metrics of $kinds" "longest_stop_s [s]: longest single stop of any vehicle" -- "$run" --list
done
prints "Populations of $scenario" "100 % CTG-Ref" "Metrics of single lights" "passed_1_veh [veh]: " -- "$run" --list "$scenario"
grep -q "Metrics of single intersections" "$work/stdout" && fail "--list names metrics that the scenario does not have"
prints "draft-07" -- "$run" --schema
python3 -c 'import json, sys; json.load(open(sys.argv[1]))' "$work/stdout" || fail "the output of --schema is not JSON"

benchmark="$STOPLINE_BIN/stopline-benchmark"
prints "--help" "--version" "Examples:" "Exit codes: 0 done, 1 " -- "$benchmark" --help
prints "stopline 0." -- "$benchmark" --version
refuses "--nonsense" -- "$benchmark" --nonsense
refuses "--benchmark_nonsense" -- "$benchmark" --benchmark_nonsense=1
refuses "no benchmark matches" -- "$benchmark" --benchmark_filter=nonsense
if [ -e /dev/full ]; then
    code=0
    "$benchmark" --benchmark_filter=batch/16/ >/dev/full 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] || fail "stopline-benchmark on a full disk: exit code $code"
fi

# examples_exist FOLDER COMMAND: runs COMMAND --help in FOLDER and expects its example programs and scenarios to exist
# there
examples_exist() {
    local folder=$1 command=$2 word
    (cd "$folder" && "$command" --help) | grep -E '^  (mpirun -n [0-9]+ )?([^ ]*/)?stopline-[a-z]+( |$)' |
        tr ' ' '\n' >"$work/words"
    grep -qE '(^|/)stopline-[a-z]+$' "$work/words" || fail "$command: the examples contain no program"
    while read -r word; do
        (cd "$folder" && command -v "$word") >"$work/stdout" || fail "$command in $folder: the program '$word' of the help does not exist"
    done < <(grep -E '(^|/)stopline-[a-z]+$' "$work/words")
    while read -r word; do
        [ -f "$folder/$word" ] || [ -f "$word" ] || fail "$command in $folder: the file '$word' of the help does not exist"
    done < <(grep -E '^(/.*/)?scenarios/.*\.yaml$' "$work/words")
}
for program in "$STOPLINE_BIN"/stopline-*; do
    examples_exist "$STOPLINE_SOURCE" "$program"
    examples_exist "$work" "$program"
    examples_exist "$STOPLINE_BIN" "./$(basename "$program")"
done
PATH="$STOPLINE_BIN:$PATH" examples_exist "$work" stopline-run
grep -qx "stopline-run" "$work/words" || fail "the help shows a path although the program is on the PATH"
prints "  ./stopline-run " -- env -C "$STOPLINE_BIN" ./stopline-run --help

refuses "no scenario file given" -- "$run"
refuses "none.yaml" -- "$run" none.yaml
quoted="the value of --set has a blank, so it needs quotes: write --set"
refuses "$quoted 'signal.green=20 s'" -- "$run" "$scenario" --set signal.green=20 s
refuses "$quoted 'signal.green=20 s'" -- "$run" --set signal.green=20 s "$scenario"
refuses "$quoted 'demand.left=20 %'" -- "$run" "$scenario" --set demand.left=20 % --no-figures
refuses "$quoted 'measure.green=[5 s, 10 s]'" -- "$run" "$scenario" --set "measure.green=[5" s, 10 "s]" --no-figures
refuses "$quoted 'title=My new run'" -- "$run" "$scenario" --set title=My new run
refuses "unknown option '--outptu' (did you mean '--output'?), unknown option '--trajectorie' (did you mean '--trajectories'?)" -- \
    "$run" "$scenario" --outptu x --trajectorie
refuses "unknown option '--population' (write --set 'populations=[CDG]' instead)" -- "$run" "$scenario" --population CDG
refuses "unknown option '--population' (write --set 'populations=[CDG]' instead)" -- "$run" "$scenario" --population=CDG
refuses "unknown option '--outputt' (did you mean '--output'?)" -- "$STOPLINE_BIN/stopline-sweep" merge --outputt x y
refuses "the argument 'other.yaml' is not expected" -- "$run" "$scenario" other.yaml
refuses "two.yaml" -- "$run" "$scenario" two.yaml
refuses "'signal.gren'" -- "$run" "$scenario" --set "signal.gren=5 s"
refuses "--interval: value '5' has no unit: write e.g. '5 s'" -- "$run" "$scenario" --trajectories --interval 5
refuses "--record-from: value '100' has no unit: write e.g. '100 s'" -- "$run" "$scenario" --record x.rec --record-from 100
refuses "whole number of steps" -- "$run" "$scenario" --trajectories --interval "15 ms"
refuses "whole number of steps" -- "$run" "$scenario" --trajectories --interval "0 s"
refuses "no rows of section 'XI'" -- "$scorecard" --section XI
refuses "--reference passage: field 'meso': there is no 'passage' in " -- "$STOPLINE_BIN/stopline-calibrate" --reference passage
refuses "did you mean 'passages'?" -- "$STOPLINE_BIN/stopline-calibrate" --step I --parameters passage
refuses "--step: value 'III' is not allowed; allowed: I, II, both" -- "$STOPLINE_BIN/stopline-calibrate" --step III

refuses "network.kind" -- "$strings" "$STOPLINE_SOURCE/scenarios/grid.yaml"
refuses "fidelity" -- "$strings" "$scenario" --set fidelity=meso
refuses "--speed: value '10' has no unit" -- "$strings" "$scenario" --speed 10
refuses "--speed: value '90 km/h' is not allowed; allowed: 5 km/h to 50 km/h" -- "$strings" "$scenario" --speed "90 km/h"
refuses "--amplitude: value '9 m/s2' is not allowed" -- "$strings" "$scenario" --amplitude "9 m/s2"
refuses "--frequency: value 'fast'" -- "$strings" "$scenario" --frequency fast
refuses "--frequency is for swings only" -- "$strings" "$scenario" --frequency 1 --manoeuvre brake
refuses "--frequency: value '0' is not allowed; allowed: 0.01 to 50" -- "$strings" "$scenario" --frequency 0
refuses "--delays has an effect only with --sweep" -- "$strings" "$scenario" --delays "20 ms"
refuses "--time-gaps has an effect only with --sweep" -- "$strings" "$scenario" --time-gaps "1 s"
refuses "--delays: value '5 ms' is not allowed; allowed: 10 ms to 2000 ms" -- \
    "$strings" "$scenario" --sweep --population CTG-Ref --delays "5 ms"
refuses "--sweep needs swings" -- "$strings" "$scenario" --sweep --manoeuvre start
refuses "--vehicles" -- "$strings" "$scenario" --vehicles 1
refuses "no population or policy 'CDX'; did you mean 'CDG'?" -- "$strings" "$scenario" --population CDX
refuses "has no time gap" -- "$strings" "$scenario" --sweep --population CDG
refuses "has a value twice" -- "$strings" "$scenario" --sweep --population CTG-Ref \
    --delays "20 ms, 20 ms"

exit $((failures > 0))
