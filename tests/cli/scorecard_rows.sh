#!/usr/bin/env bash
# stopline-scorecard: the columns promised, rows by section, reuse, and the exit codes.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
scorecard="$STOPLINE_BIN/stopline-scorecard"

"$scorecard" --section III --csv --output "$work/out" >"$work/rows.csv" 2>"$work/stderr" || fail "exit code $?"
[ "$(head -n 1 "$work/rows.csv")" = "id,section,paper,ours,unit,tolerance,verdict,explanation" ] || fail "other columns"
expect_documented "$work/out/scorecard.csv" scorecard/scorecard.csv
cmp -s "$work/rows.csv" "$work/out/scorecard.csv" || fail "what is printed is not what is kept"
expected=$(grep -c ',III\.' "$STOPLINE_SOURCE/data/paper/targets.csv")
[ "$(tail -n +2 "$work/rows.csv" | grep -c .)" -eq "$expected" ] || fail "not the $expected rows of Section III"
grep -q ',open,' "$work/rows.csv" && fail "rows of Section III are open"
grep -q 'single_light: running' "$work/stderr" || fail "nothing was run: $(cat "$work/stderr")"

"$scorecard" --section III --csv --output "$work/out" >"$work/again.csv" 2>"$work/stderr" || fail "exit code $?"
cmp -s "$work/rows.csv" "$work/again.csv" || fail "what was measured before gives other rows"
grep -q 'already measured' "$work/stderr" || fail "measured again: $(cat "$work/stderr")"

# The table agrees with the CSV on the verdicts.
"$scorecard" --section III --output "$work/out" >"$work/table" 2>/dev/null || fail "exit code $?"
for verdict in inside miss; do
    count=$(grep -cE ",$verdict," "$work/rows.csv")
    grep -qE "(^|, )$count $verdict(,|$)" "$work/table" || fail "the table does not count $count $verdict"
done
grep -q ', 0 open' "$work/table" || fail "the table counts open rows"

# Whatever misses is explained, and --strict tells.
misses=$(grep -c ',miss,' "$work/rows.csv")
code=0
"$scorecard" --section III --strict --output "$work/out" >/dev/null 2>&1 || code=$?
[ $code -eq $((misses > 0)) ] || fail "--strict with $misses misses: exit code $code"
[ "$(grep -c '^[A-Z][0-9][0-9]  misses: ' "$work/table")" -eq "$misses" ] || fail "a miss without a word"
grep -q 'Not explained yet' "$work/table" && fail "a miss is not explained: $(grep 'Not explained' "$work/table")"

# Rows for which the paper states no tolerance are there, open.
"$scorecard" --section V.A --csv --output "$work/out" >"$work/later.csv" 2>/dev/null || fail "exit code $?"
[ "$(grep -c '^C[0-9][0-9],' "$work/later.csv")" -eq "$(grep -c ',V.A' "$STOPLINE_SOURCE/data/paper/targets.csv")" ] ||
    fail "not the rows of Section V.A"

# The hint at the end is of the section shown.
grep -qE '^  .*/stopline-run .*scenarios/single_light.yaml$' "$work/table" || fail "no command for the runs of Section III"
"$scorecard" --section V.A --output "$work/out" >"$work/later" 2>/dev/null || fail "exit code $?"
grep -qE '^  .*/stopline-calibrate$' "$work/later" || fail "no command for the runs of Section V: $(tail -n 2 "$work/later")"

exit $((failures > 0))
