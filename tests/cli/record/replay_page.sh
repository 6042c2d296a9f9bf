#!/usr/bin/env bash
# ctest-labels: slow
# Tests the page of stopline-replay in a headless browser. Skipped if there is none.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
"$STOPLINE_BIN/stopline-run" "$STOPLINE_SOURCE/scenarios/intersection.yaml" --set 'populations=[CDG]' --set measure.baseline=CDG \
    --set measure.cycles=2 --set 'demand.left=15 %' --set 'demand.right=30 %' --no-figures --trajectories --interval "1 s" --record "$work/crossing.rec" \
    --output "$work/crossing" >"$work/stdout" || fail "intersection: exit code $?"
"$STOPLINE_BIN/stopline-run" "$STOPLINE_SOURCE/scenarios/grid.yaml" --set 'populations=[CDG]' --set measure.baseline=CDG \
    --set network.grid.columns=7 --set network.grid.rows=7 --set 'duration=320 s' --set 'measure.window=100 s' \
    --record-from "250 s" --threads 1 --record "$work/large.rec" --no-figures --output "$work/large" >"$work/stdout" ||
    fail "grid: exit code $?"
for name in crossing large; do
    "$STOPLINE_BIN/stopline-replay" "$work/$name.rec" >"$work/stdout" || fail "replay of $name: exit code $?"
done
python3 "$STOPLINE_SOURCE/tests/replay/page_test.py" "$work/crossing.html" "$work/crossing/trajectories.csv" "$work/large.html"
code=$?
[ $code -eq 77 ] && exit 77
exit $((failures > 0 || code != 0))
