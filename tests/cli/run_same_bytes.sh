#!/usr/bin/env bash
# ctest-timeout: 600
# The same bytes whatever the number of threads, from run to run, and with and without optimisation.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"

# results FOLDER BIN THREADS SCENARIO [OPTION...]
results() {
    local folder=$1 bin=$2 threads=$3 scenario=$4
    shift 4
    "$bin/stopline-run" "$STOPLINE_SOURCE/scenarios/$scenario.yaml" --threads "$threads" --no-figures --trajectories \
        --output "$folder" "$@" >/dev/null || fail "$scenario on $threads threads: exit code $?"
}

same() {
    local what=$1 first=$2 second=$3
    diff -r "$first" "$second" >"$work/difference" || fail "$what: $(head -n 5 "$work/difference")"
}

short=(--set "demand.vehicles=6" --set "duration=90 s")
results "$work/one" "$STOPLINE_BIN" 1 first_steps "${short[@]}"
[ -s "$work/one/trajectories.csv" ] || fail "nothing to compare"
results "$work/two" "$STOPLINE_BIN" 2 first_steps "${short[@]}"
same "1 and 2 threads" "$work/one" "$work/two"
results "$work/again" "$STOPLINE_BIN" 1 first_steps "${short[@]}"
same "two runs" "$work/one" "$work/again"
results "$work/five" "$STOPLINE_BIN" 5 single_light --interval "1 s"
results "$work/serial" "$STOPLINE_BIN" 1 single_light --interval "1 s"
same "1 and 5 threads, all populations" "$work/five" "$work/serial"
results "$work/other" "$STOPLINE_BIN" 1 first_steps "${short[@]}" --set "policies[CDG].standstill_gap=3 m"
diff -q "$work/one/passages.csv" "$work/other/passages.csv" >/dev/null && fail "another scenario gives the same passages"

# Several intersections, with all that is written of hindrance.
small=(--set "network.grid.columns=3" --set "duration=600 s" --set "measure.window=300 s" --no-figures)
"$STOPLINE_BIN/stopline-run" "$STOPLINE_SOURCE/scenarios/arterial.yaml" --threads 1 --output "$work/street" "${small[@]}" \
    >"$work/table" || fail "arterial: exit code $?"
for part in "gridlock" "teleported" "stability" "No overlaps" "delays.csv"; do
    grep -qF -- "$part" "$work/table" || fail "arterial: no '$part' in the report"
done
[ "$(wc -l <"$work/street/series.csv")" -eq 31 ] || fail "arterial: series.csv has not ten rows for each of three populations"
head -n 1 "$work/street/delays.csv" | grep -q "^population,cause,lane,vehicle,blocker,blocker_lane,from_s,to_s," ||
    fail "arterial: delays.csv begins with $(head -n 1 "$work/street/delays.csv")"
"$STOPLINE_BIN/stopline-run" "$STOPLINE_SOURCE/scenarios/arterial.yaml" --threads 2 --output "$work/street_two" \
    "${small[@]}" >/dev/null || fail "arterial on two threads: exit code $?"
same "an arterial on 1 and 2 threads" "$work/street" "$work/street_two"

if [ -n "${STOPLINE_DEBUG_BIN:-}" ] && [ -x "$STOPLINE_DEBUG_BIN/stopline-run" ]; then
    results "$work/debug" "$STOPLINE_DEBUG_BIN" 2 first_steps "${short[@]}"
    same "release and debug" "$work/one" "$work/debug"
else
    echo "no debug build (STOPLINE_DEBUG_BIN): not compared"
fi

exit $((failures > 0))
