#!/usr/bin/env bash
# Tests the output of stopline-run: complete files with units in their headers, or exit code 2 and a message with path
# and reason.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
run="$STOPLINE_BIN/stopline-run"
scenario="$STOPLINE_SOURCE/scenarios/first_steps.yaml"

# cannot_write REASON FOLDER [OPTION...]: expects exit code 2 and a message with REASON and FOLDER
cannot_write() {
    local reason=$1 folder=$2
    shift 2
    local code=0
    "$run" "$scenario" --no-figures --output "$folder" "$@" >"$work/stdout" 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] || fail "output $folder: exit code $code instead of 2"
    grep -qF -- "$folder" "$work/stderr" || fail "output $folder: the folder is not named in: $(cat "$work/stderr")"
    grep -qF -- "$reason" "$work/stderr" || fail "output $folder: '$reason' is missing in: $(cat "$work/stderr")"
}

"$run" "$scenario" --output "$work/out" --trajectories --interval "0.5 s" >"$work/table" || fail "exit code $?"
for part in "Vehicles passed" "improvement over CTG-Ref" "headway" "No overlaps" "Next:"; do
    grep -qF "$part" "$work/table" || fail "'$part' is missing in the report"
done
# expect_header FILE HEADER: expects HEADER as the first line of FILE
expect_header() {
    [ "$(head -n 1 "$work/out/$1")" = "$2" ] || fail "$1 begins with: $(head -n 1 "$work/out/$1")"
}
expect_header passages.csv "population,lane,position,vehicle,policy,time_s,headway_s,speed_mps"
expect_header improvement.csv "population,green_s,passed_veh,baseline,baseline_passed_veh,improvement_percent"
expect_header trajectories.csv \
    "population,time_s,vehicle,policy,lane,position_m,speed_mps,acceleration_mps2,request_mps2,net_gap_m,gear"
"$run" "$STOPLINE_SOURCE/scenarios/intersection.yaml" --set 'populations=[CDG]' --set measure.baseline=CDG \
    --set measure.cycles=1 --no-figures --trajectories --interval "1 s" --output "$work/crossing" >"$work/table" ||
    fail "intersection: exit code $?"
[ "$(head -n 1 "$work/crossing/trajectories.csv")" = "population,time_s,vehicle,policy,lane,position_m,x_m,y_m,speed_mps,\
acceleration_mps2,request_mps2,net_gap_m,gear" ] || fail "intersection: $(head -n 1 "$work/crossing/trajectories.csv")"
[ "$(wc -l <"$work/crossing/trajectories.csv")" -gt 5000 ] || fail "intersection: trajectories.csv has too few rows"
head -n 1 "$work/out/summary.csv" | grep -q "steady_headway_s,policy_headway_s" || fail "summary.csv has no headway columns"
provenance="$work/out/first_steps.provenance.json"
for part in '"scenario_hash"' '"version"' '"seed": 1' '"command"' '"state_hashes"' 'vehicles: 10' 'trajectories.csv' \
    "--trajectories --interval '0.5 s'"; do
    grep -qF -- "$part" "$provenance" || fail "'$part' is missing in the provenance"
done
if command -v gnuplot >"$work/stdout"; then
    for figure in counters improvement time_space platoon; do
        for type in svg png; do
            [ -s "$work/out/$figure.$type" ] || fail "$figure.$type is missing or empty"
        done
    done
fi
(PATH=/nonexistent "$run" "$scenario" --output "$work/plain" >"$work/table") || fail "without gnuplot: exit code $?"
grep -qF "gnuplot is not installed" "$work/table" || fail "without gnuplot: the report does not say so"
[ -e "$work/plain/counters.svg" ] && fail "without gnuplot: there is a figure"

# briefly OPTION...: runs the intersection with a short green, without yellow and without all red. The first run below
# lasts eight cycles: vehicles collide in the junction, so its exit code is 1. The second run lasts a single cycle, too
# short for one of the figures.
briefly() {
    code=0
    "$run" "$STOPLINE_SOURCE/scenarios/intersection.yaml" --set demand.left="30 %" --set signal.green="5 s" \
        --set signal.yellow="0 s" --set signal.all_red="0 s" --set measure.warmup_cycles=0 "$@" >"$work/table" 2>"$work/stderr" ||
        code=$?
}
briefly --set network.intersection.clearance="5 m" --set network.intersection.lane_width="6 m" --set measure.cycles=8 \
    --no-figures --output "$work/violating"
[ $code -eq 1 ] || fail "violations: exit code $code instead of 1: $(cat "$work/stderr")"
grep -q "^VIOLATIONS in" "$work/table" || fail "violations are not reported"
briefly --set signal.green="1 s" --set measure.cycles=1 --output "$work/brief"
[ $code -eq 0 ] || fail "green of 1 s: exit code $code: $(cat "$work/stderr")"
[ -e "$work/brief/headways.svg" ] && fail "there is a figure without data"

# A short run of a network: one figure is left out, the others are drawn.
code=0
"$run" "$STOPLINE_SOURCE/scenarios/arterial.yaml" --set duration="30 s" --set measure.window="10 s" \
    --set measure.time_space="0.5 s" --output "$work/arterial" >"$work/table" 2>"$work/stderr" || code=$?
[ $code -eq 0 ] || fail "short run of a network: exit code $code: $(cat "$work/stderr")"
if command -v gnuplot >"$work/stdout"; then
    grep -q "no figure series: .* no whole interval of 60 s" "$work/table" || fail "the omitted figure is not reported"
    [ -s "$work/arterial/delay_causes.svg" ] || fail "delay_causes.svg is missing"
fi

# The hint to the mesoscale mode names the parameters that were fitted to full dynamics, unless others are chosen.
hint_of() {
    "$run" "$STOPLINE_SOURCE/scenarios/berlin.yaml" --set fidelity=full --set 'populations=[CDG]' --set duration="10 s" \
        --set measure.time_space="0 s" --set measure.window="10 s" --set measure.baseline=none --no-figures \
        --output "$work/hint" "$@" 2>&1 | grep "another fidelity"
}
[ "$(hint_of --set meso=table2)" = "  another fidelity: add --set fidelity=meso --set meso=passages" ] ||
    fail "hint: $(hint_of --set meso=table2)"
[ "$(hint_of --set meso=fitted)" = "  another fidelity: add --set fidelity=meso" ] || fail "hint: $(hint_of --set meso=fitted)"

touch "$work/file"
cannot_write "Not a directory" "$work/file/below"
cannot_write "Not a directory" "$work/file"
[ -d /proc/self ] && cannot_write "cannot create the folder" /proc/stopline
if [ "$(id -u)" -ne 0 ]; then
    mkdir "$work/closed"
    chmod a-w "$work/closed"
    cannot_write "Permission denied" "$work/closed"
fi
if [ -e /dev/full ]; then
    mkdir "$work/full"
    ln -s /dev/full "$work/full/passages.csv"
    cannot_write "No space left on device" "$work/full"
    code=0
    "$run" "$scenario" --no-figures --output "$work/to_full" >/dev/full 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] || fail "standard output on a full disk: exit code $code"
    grep -q "standard output" "$work/stderr" || fail "standard output on a full disk: the error is not reported"
    for long_text in --schema --describe; do
        code=0
        "$run" $long_text >/dev/full 2>"$work/stderr" || code=$?
        [ $code -eq 2 ] || fail "$long_text on a full disk: exit code $code"
        [ "$(cat "$work/stderr")" = "stopline-run: cannot write to standard output" ] ||
            fail "$long_text on a full disk: $(cat "$work/stderr")"
    done
fi

# A folder that holds a file of another run
"$run" "$scenario" --no-figures --output "$work/twice" >"$work/stdout" 2>"$work/stderr" || fail "exit code $?"
grep -q "did not write" "$work/stderr" && fail "a new folder: $(cat "$work/stderr")"
touch "$work/twice/series.csv"
"$run" "$scenario" --no-figures --output "$work/twice" >"$work/stdout" 2>"$work/stderr" || fail "exit code $?"
[ "$(cat "$work/stderr")" = "note: $work/twice also holds files that this run did not write: series.csv" ] ||
    fail "a folder with an older file: $(cat "$work/stderr")"

# A file size limit stands in for a disk that becomes full during the run. 8 blocks of 1024 bytes are less than the
# trajectories need.
mkdir "$work/small"
(
    ulimit -f 8
    cannot_write "File too large" "$work/small" --trajectories
    exit $((failures > 0))
) || failures=$((failures + 1))
[ -e "$work/small/trajectories.csv" ] && fail "an incomplete trajectories.csv is left"
[ -z "$(find "$work/small" -name '*.part')" ] || fail "temporary files are left: $(ls -A "$work/small")"

exit $((failures > 0))
