#!/usr/bin/env bash
# Tests that merged shards give the same bytes as one program, and that overlapping or missing shards are refused.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
program="$STOPLINE_BIN/stopline-sweep"
# The shipped sweep, reduced to the first vehicle type and the first hesitation of the driver, and run with six seeds.
sweep="$work/single_light.yaml"
sed -e "s#^scenario: \.\./#scenario: $STOPLINE_SOURCE/scenarios/#" \
    -e "s/, electric_100kw//" -e "s/, 0.5 s, 1 s//" -e "s/^repetitions: 1/repetitions: 6/" \
    "$STOPLINE_SOURCE/scenarios/sweeps/single_light.yaml" >"$sweep"
short=(--set "duration=300 s" --set "demand.vehicles=10")

# refused CASE PART COMMAND...: expects exit code 2 and PART in the message
refused() {
    local case_name=$1 part=$2
    shift 2
    local code=0
    "$@" >"$work/stdout" 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] || fail "$case_name: exit code $code instead of 2"
    grep -qF -- "$part" "$work/stderr" || fail "$case_name: '$part' is missing in: $(cat "$work/stderr")"
}

# same_results CASE FOLDER: expects the results of the whole sweep in FOLDER
same_results() {
    for file in single_light.csv single_light.provenance.json; do
        cmp "$work/whole/$file" "$2/$file" || fail "$1: $file differs"
    done
}

"$program" "$sweep" "${short[@]}" --output "$work/whole" >/dev/null || fail "exit code $?"
for k in 1 2 3; do
    "$program" "$sweep" "${short[@]}" --shard $k/3 --output "$work/shards" >"$work/stdout" || fail "shard $k: exit code $?"
    grep -q "^6 runs now" "$work/stdout" || fail "shard $k: the number of runs is not 6: $(cat "$work/stdout")"
done
"$program" "$sweep" "${short[@]}" --shard 2/2 --output "$work/half" >/dev/null || fail "exit code $?"
"$program" "$sweep" --shard 1/3 --output "$work/other" >/dev/null || fail "exit code $?"

# shard K: prints the path of the store of shard K
shard() {
    echo "$work/shards/single_light.shard-$1-of-3.sqlite"
}
merge=("$program" merge --output "$work/merged")
refused "missing shard" "6 of 18 runs are missing: " "${merge[@]}" "$(shard 1)" "$(shard 3)"
refused "overlapping shards" "overlap: both have run" "${merge[@]}" "$work/shards"/*.sqlite "$work/half"/*.sqlite
refused "same store twice" "given twice" "${merge[@]}" "$(shard 1)" "$(shard 2)" "$(shard 3)" "$(shard 2)"
refused "different scenario" "their sweeps or scenarios differ" "${merge[@]}" "$(shard 2)" "$(shard 3)" \
    "$work/other/single_light.shard-1-of-3.sqlite"
refused "file that is not a store" "not a store" "${merge[@]}" "$sweep"
refused "missing store" "no such file" "${merge[@]}" "$work/none.sqlite"
[ -z "$(ls -A "$work/merged")" ] || fail "a refused merge leaves files: $(ls -A "$work/merged")"
"${merge[@]}" "$(shard 3)" "$(shard 1)" "$(shard 2)" >/dev/null || fail "merge: exit code $?"
same_results "three shards" "$work/merged"
refused "merge into an existing store" "the store exists already" "${merge[@]}" "$(shard 3)" "$(shard 1)" "$(shard 2)"
"$program" "$sweep" "${short[@]}" --output "$work/merged" >"$work/stdout" || fail "exit code $?"
grep -q "were done before" "$work/stdout" || fail "the merged store is not complete"
cmp "$work/whole/single_light_means.csv" "$work/merged/single_light_means.csv" || fail "single_light_means.csv differs"
[ -z "$(find "$work/shards" -name '*_means.csv')" ] || fail "a shard has a table of means"

exit $((failures > 0))
