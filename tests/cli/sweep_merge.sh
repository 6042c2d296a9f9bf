#!/usr/bin/env bash
# Shards that are joined, and ranks of mpirun, give the same bytes as one program; overlaps and holes are refused.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
program="$STOPLINE_BIN/stopline-sweep"
sweep="$work/single_light.yaml" # one vehicle and hesitation, six seeds: each shard has some of each combination
sed -e "s#^scenario: \.\./#scenario: $STOPLINE_SOURCE/scenarios/#" \
    -e "s/, electric_100kw//" -e "s/, 0.5 s, 1 s//" -e "s/^repetitions: 1/repetitions: 6/" \
    "$STOPLINE_SOURCE/scenarios/sweeps/single_light.yaml" >"$sweep"
short=(--set "duration=300 s" --set "demand.vehicles=10")

# refused WHAT PART COMMAND...: exit code 2, PART in the message
refused() {
    local what=$1 part=$2
    shift 2
    local code=0
    "$@" >"$work/stdout" 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] || fail "$what: exit code $code instead of 2"
    grep -qF -- "$part" "$work/stderr" || fail "$what: no '$part' in: $(cat "$work/stderr")"
}

same_results() {
    for file in single_light.csv single_light.provenance.json; do
        cmp "$work/whole/$file" "$2/$file" || fail "$1: another $file"
    done
}

"$program" "$sweep" "${short[@]}" --output "$work/whole" >/dev/null || fail "exit code $?"
for k in 1 2 3; do
    "$program" "$sweep" "${short[@]}" --shard $k/3 --output "$work/shards" >"$work/stdout" || fail "shard $k: exit code $?"
    grep -q "^6 runs now" "$work/stdout" || fail "shard $k: not 6 of 18 runs: $(cat "$work/stdout")"
done
"$program" "$sweep" "${short[@]}" --shard 2/2 --output "$work/half" >/dev/null || fail "exit code $?"
"$program" "$sweep" --shard 1/3 --output "$work/other" >/dev/null || fail "exit code $?"

shard() {
    echo "$work/shards/single_light.shard-$1-of-3.sqlite"
}
merge=("$program" merge --output "$work/merged")
refused "a hole" "6 of 18 runs are missing: " "${merge[@]}" "$(shard 1)" "$(shard 3)"
refused "an overlap" "overlap: both have run" "${merge[@]}" "$work/shards"/*.sqlite "$work/half"/*.sqlite
refused "the same store twice" "given twice" "${merge[@]}" "$(shard 1)" "$(shard 2)" "$(shard 3)" "$(shard 2)"
refused "another scenario" "their sweeps or scenarios differ" "${merge[@]}" "$(shard 2)" "$(shard 3)" \
    "$work/other/single_light.shard-1-of-3.sqlite"
refused "no store" "not a store" "${merge[@]}" "$sweep"
refused "a missing store" "no such file" "${merge[@]}" "$work/none.sqlite"
[ -z "$(ls -A "$work/merged")" ] || fail "a refused merge leaves $(ls -A "$work/merged")"
"${merge[@]}" "$(shard 3)" "$(shard 1)" "$(shard 2)" >/dev/null || fail "merge: exit code $?"
same_results "three shards" "$work/merged"
refused "merged before" "there is a store" "${merge[@]}" "$(shard 3)" "$(shard 1)" "$(shard 2)"
"$program" "$sweep" "${short[@]}" --output "$work/merged" >"$work/stdout" || fail "exit code $?"
grep -q "were done before" "$work/stdout" || fail "the joined store is not complete"
cmp "$work/whole/single_light_means.csv" "$work/merged/single_light_means.csv" || fail "other means"
[ -z "$(find "$work/shards" -name '*_means.csv')" ] || fail "a shard has means of its own runs alone"

exit $((failures > 0))
