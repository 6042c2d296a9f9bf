#!/usr/bin/env bash
# ctest-timeout: 600
# Tests that results have the same bytes for any number of threads, from run to run, and with and without optimisation.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"

# results FOLDER BIN THREADS SCENARIO [OPTION...]: writes the results of a scenario to FOLDER
results() {
    local folder=$1 bin=$2 threads=$3 scenario=$4
    shift 4
    "$bin/stopline-run" "$STOPLINE_SOURCE/scenarios/$scenario.yaml" --threads "$threads" --no-figures --trajectories \
        --output "$folder" "$@" >/dev/null || fail "$scenario on $threads threads: exit code $?"
}

# same CASE FOLDER FOLDER: expects equal files in both folders
same() {
    local case_name=$1 first=$2 second=$3
    diff -r "$first" "$second" >"$work/difference" || fail "$case_name: $(head -n 5 "$work/difference")"
}

short=(--set "demand.vehicles=6" --set "duration=90 s")
results "$work/one" "$STOPLINE_BIN" 1 first_steps "${short[@]}"
[ -s "$work/one/trajectories.csv" ] || fail "there are no trajectories to compare"
results "$work/two" "$STOPLINE_BIN" 2 first_steps "${short[@]}"
same "1 and 2 threads" "$work/one" "$work/two"
results "$work/again" "$STOPLINE_BIN" 1 first_steps "${short[@]}"
same "two runs" "$work/one" "$work/again"
results "$work/five" "$STOPLINE_BIN" 5 single_light --interval "1 s"
results "$work/serial" "$STOPLINE_BIN" 1 single_light --interval "1 s"
same "1 and 5 threads, all populations" "$work/five" "$work/serial"
results "$work/other" "$STOPLINE_BIN" 1 first_steps "${short[@]}" --set "policies[CDG].standstill_gap=3 m"
diff -q "$work/one/passages.csv" "$work/other/passages.csv" >/dev/null && fail "a different scenario gives the same passages"

# An arterial, with all tables of delays and gridlocks.
small=(--set "network.grid.columns=3" --set "duration=600 s" --set "measure.window=300 s" --no-figures)
"$STOPLINE_BIN/stopline-run" "$STOPLINE_SOURCE/scenarios/arterial.yaml" --threads 1 --output "$work/street" "${small[@]}" \
    >"$work/table" || fail "arterial: exit code $?"
for part in "gridlock" "teleported" "stability" "No overlaps" "delays.csv"; do
    grep -qF -- "$part" "$work/table" || fail "arterial: '$part' is missing in the report"
done
[ "$(wc -l <"$work/street/series.csv")" -eq 31 ] || fail "arterial: series.csv has not 10 rows for each of 3 populations"
head -n 1 "$work/street/delays.csv" | grep -q "^population,cause,lane,vehicle,blocker,blocker_lane,from_s,to_s," ||
    fail "arterial: delays.csv begins with $(head -n 1 "$work/street/delays.csv")"
"$STOPLINE_BIN/stopline-run" "$STOPLINE_SOURCE/scenarios/arterial.yaml" --threads 2 --output "$work/street_two" \
    "${small[@]}" >/dev/null || fail "arterial on two threads: exit code $?"
same "an arterial on 1 and 2 threads" "$work/street" "$work/street_two"

if [ -n "${STOPLINE_DEBUG_BIN:-}" ] && [ -x "$STOPLINE_DEBUG_BIN/stopline-run" ]; then
    results "$work/debug" "$STOPLINE_DEBUG_BIN" 2 first_steps "${short[@]}"
    same "release and debug" "$work/one" "$work/debug"
else
    echo "the debug build is not compared: STOPLINE_DEBUG_BIN is not set"
fi

exit $((failures > 0))
