#!/usr/bin/env bash
# Tests stopline-scorecard: columns, rows by section, reuse of results, exit codes.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
scorecard="$STOPLINE_BIN/stopline-scorecard"

"$scorecard" --section III --csv --output "$work/out" >"$work/rows.csv" 2>"$work/stderr" || fail "exit code $?"
[ "$(head -n 1 "$work/rows.csv")" = "id,section,paper,ours,unit,tolerance,verdict,explanation" ] || fail "the columns differ"
expect_documented "$work/out/scorecard.csv" scorecard/scorecard.csv
cmp -s "$work/rows.csv" "$work/out/scorecard.csv" || fail "the printed rows differ from scorecard.csv"
expected=$(grep -c ',III\.' "$STOPLINE_SOURCE/data/paper/targets.csv")
[ "$(tail -n +2 "$work/rows.csv" | grep -c .)" -eq "$expected" ] || fail "the number of rows of Section III is not $expected"
grep -q ',open,' "$work/rows.csv" && fail "Section III has open rows"
grep -q 'single_light: running' "$work/stderr" || fail "no run was reported: $(cat "$work/stderr")"

"$scorecard" --section III --csv --output "$work/out" >"$work/again.csv" 2>"$work/stderr" || fail "exit code $?"
cmp -s "$work/rows.csv" "$work/again.csv" || fail "reused results give different rows"
grep -q 'already measured' "$work/stderr" || fail "results were not reused: $(cat "$work/stderr")"

# The table agrees with the CSV on the verdicts.
"$scorecard" --section III --output "$work/out" >"$work/table" 2>/dev/null || fail "exit code $?"
for verdict in inside miss input; do
    count=$(grep -cE ",$verdict," "$work/rows.csv")
    grep -qE "(^|[,;] )$count $verdict([,;]|$)" "$work/table" || fail "the table does not count $count $verdict"
done
grep -q ', 0 open' "$work/table" || fail "the table counts open rows"

# Every miss has an explanation. --strict returns 1 if there is a miss.
misses=$(grep -c ',miss,' "$work/rows.csv")
code=0
"$scorecard" --section III --strict --output "$work/out" >/dev/null 2>&1 || code=$?
[ $code -eq $((misses > 0)) ] || fail "--strict with $misses misses: exit code $code"
[ "$(grep -c '^[A-Z][0-9][0-9]  misses: ' "$work/table")" -eq "$misses" ] || fail "a miss has no line in the table"
grep -q 'Not explained yet' "$work/table" && fail "a miss is not explained: $(grep 'Not explained' "$work/table")"

# Every row of Section V.A in targets.csv appears in the scorecard, also rows without a tolerance.
"$scorecard" --section V.A --csv --output "$work/out" >"$work/later.csv" 2>/dev/null || fail "exit code $?"
[ "$(grep -c '^C[0-9][0-9],' "$work/later.csv")" -eq "$(grep -c ',V.A' "$STOPLINE_SOURCE/data/paper/targets.csv")" ] ||
    fail "the number of rows of Section V.A differs from targets.csv"

# The hint at the end names the command for the section.
grep -qE '^  .*/stopline-run .*scenarios/single_light.yaml$' "$work/table" || fail "the command for the runs of Section III is missing"
"$scorecard" --section V.A --output "$work/out" >"$work/later" 2>/dev/null || fail "exit code $?"
grep -qE '^  .*/stopline-calibrate$' "$work/later" || fail "the command for the runs of Section V is missing: $(tail -n 2 "$work/later")"

exit $((failures > 0))
