#!/usr/bin/env bash
# ctest-labels: slow
# Tests that a killed search of stopline-signals continues from its store, with the same result.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
program="$STOPLINE_BIN/stopline-signals"

# search FOLDER: sets `command` to a search of some seconds, with results in FOLDER
search() {
    command=("$program" "$STOPLINE_SOURCE/scenarios/arterial.yaml" --set demand.kind=rate --set 'demand.inflow=500 veh/h'
        --set 'duration=600 s' --set 'measure.window=300 s' --population CTG-Ref --search --seeds 2 --greens 3
        --offsets 3 --no-figures --threads 1 --output "$1")
}

search "$work/whole"
"${command[@]}" >"$work/stdout" 2>/dev/null || fail "exit code $?"
runs=$(sed -n 's/ runs, .* of them now$//p' "$work/stdout")
[ "${runs:-0}" -ge 30 ] || fail "the search has '$runs' runs"

# The kill waits for the store, so that it hits the search and not the measurement of the saturation flow.
now=0
for seconds in 0.5 0.1 2 0.02; do
    rm -rf "$work/killed"
    search "$work/killed"
    "${command[@]}" >/dev/null 2>&1 &
    pid=$!
    wait_for [ -s "$work/killed/search_CTG-Ref.sqlite-wal" ] || fail "there is no store"
    sleep $seconds
    kill -KILL $pid 2>/dev/null
    wait $pid 2>/dev/null
    [ -e "$work/killed/search.csv" ] && continue
    "${command[@]}" >"$work/stdout" 2>/dev/null || fail "after a kill: exit code $?"
    now=$(sed -n 's/^.* runs, \(.*\) of them now$/\1/p' "$work/stdout")
    [ "${now:-0}" -gt 0 ] && [ "$now" -lt "$runs" ] && break
done
if [ "${now:-0}" -eq 0 ] || [ "$now" -ge "$runs" ]; then
    fail "after a kill: $now of $runs runs are repeated"
fi
cmp "$work/whole/search.csv" "$work/killed/search.csv" || fail "after a kill: search.csv differs"
cmp "$work/whole/search_CTG-Ref.csv" "$work/killed/search_CTG-Ref.csv" || fail "after a kill: the table of runs differs"

# Ctrl-C gives exit code 130 and a message on how to continue.
search "$work/stopped"
"${command[@]}" >/dev/null 2>"$work/stderr" &
pid=$!
wait_for [ -s "$work/stopped/search_CTG-Ref.sqlite-wal" ] || fail "there is no store"
kill -INT $pid
code=0
wait $pid || code=$?
[ $code -eq 130 ] || fail "Ctrl-C: exit code $code"
grep -q "the same command continues" "$work/stderr" || fail "Ctrl-C: $(cat "$work/stderr")"

# Another demand has another store.
search "$work/whole"
code=0
"${command[@]}" --set 'demand.inflow=510 veh/h' >/dev/null 2>"$work/stderr" || code=$?
[ $code -eq 2 ] || fail "other demand: exit code $code instead of 2"
grep -q "has changed since" "$work/stderr" || fail "other demand: $(cat "$work/stderr")"

exit $((failures > 0))
