#!/usr/bin/env bash
# Tests corridor.py on two intersections: its demand, its tables, and that it stores SUMO's results. Tests that
# stopline-run accepts random corridors. Skipped if SUMO is not installed.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
tools="$STOPLINE_SOURCE/tests/sumo"

# The three lanes of an approach carry equal traffic. 8 % of all vehicles turn left, all of them from the left lane. So
# 24 % of the vehicles on the left lane turn left.
(cd "$tools" && python3 - <<'END') || fail "turn shares by lane"
import street_inputs
rows = street_inputs.shares_by_lane([{"straight", "left"}, {"straight"}, {"straight", "right"}],
                                    {"straight": 0.80, "right": 0.12, "left": 0.08})
expected = [(0.76, 0.0, 0.24), (1.0, 0.0, 0.0), (0.64, 0.36, 0.0)]
for row, (straight, right, left) in zip(rows, expected):
    total = sum(row.values())
    assert abs(row["straight"] / total - straight) + abs(row["right"] / total - right) + abs(row["left"] / total - left) < 1e-6
assert street_inputs.turn_of("a_west_in", "a_north_out") == "left"
assert street_inputs.turn_of("a_west_in", "b_west_in.1") == "straight"
assert street_inputs.turn_of("b_north_in", "a_east_in") == "right"
END

compare() {
    python3 "$tools/corridor.py" --bin "$STOPLINE_BIN" --layout "$STOPLINE_SOURCE/tests/data/two_intersections.yaml" \
        --policy CTG --seeds 1 --warm-up 60 --cache "$work/cache" --output "$work/out" "$@" >"$work/stdout" 2>"$work/stderr"
}
compare --duration 180
code=$?
[ $code -eq 77 ] && exit 77
[ $code -le 1 ] || fail "exit code $code: $(head -c 500 "$work/stderr")"
grep -q "^leave the area" "$work/stdout" || fail "no throughput: $(head -c 500 "$work/stdout")"
grep -qE "not saturated|expected" "$work/stdout" && fail "demand of SUMO: $(grep -E 'not saturated|expected' "$work/stdout")"
[ "$(wc -l <"$work/out/comparison.csv")" -eq 24 ] || fail "rows of comparison.csv: $(wc -l <"$work/out/comparison.csv")"
cp "$work/out/comparison.csv" "$work/first.csv"
compare --duration 180
cmp -s "$work/out/comparison.csv" "$work/first.csv" || fail "a second comparison gives other results"
compare --duration 120
[ "$(find "$work/cache" -name '*.json' | wc -l)" -eq 1 ] || fail "SUMO's results are not used again"

python3 "$tools/random_corridors.py" --bin "$STOPLINE_BIN" --write-only --count 3 --output "$work/streets" >"$work/stdout"
for number in 1 2 3; do
    "$STOPLINE_BIN/stopline-run" "$STOPLINE_SOURCE/scenarios/berlin.yaml" --no-figures --output "$work/run" \
        --set "network.streets=$work/streets/corridor_$number.yaml" --set 'populations=[CTG-Ref]' --set 'duration=60 s' \
        --set 'measure.window=30 s' >/dev/null 2>"$work/stderr" || fail "corridor $number: $(head -c 300 "$work/stderr")"
done

exit $((failures > 0))
