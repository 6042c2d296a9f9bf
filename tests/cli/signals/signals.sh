#!/usr/bin/env bash
# Tests stopline-signals: its tables, its options that apply the times, its search and figure, and its error messages.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
program="$STOPLINE_BIN/stopline-signals"
intersection="$STOPLINE_SOURCE/scenarios/intersection.yaml"
rate=(--set demand.kind=rate --set demand.start=empty --set fidelity=meso --set meso=passages)

# cell FILE COLUMN: prints the cell of a column in the first row of a CSV file
cell() {
    awk -F, -v name="$2" 'NR == 1 { for (i = 1; i <= NF; ++i) if ($i == name) column = i } NR == 2 { print $column }' "$1"
}

# The start values. The printed options and the YAML give the same times.
"$program" "$intersection" "${rate[@]}" --set 'demand.inflow=900 veh/h' --population CTG-Ref --population CDG \
    --output "$work/start" >"$work/stdout" 2>"$work/stderr" || fail "start values: exit code $?: $(cat "$work/stderr")"
[ -s "$work/stderr" ] && fail "start values: $(cat "$work/stderr")"
for part in "saturation" "lost time" "level of" "Webster" "--set 'signal.green=" "  cross_green: " "Next: run the scenario"; do
    grep -qF -- "$part" "$work/stdout" || fail "start values: '$part' is missing"
done
[ "$(wc -l <"$work/start/timing.csv")" -eq 3 ] || fail "timing.csv has not two populations"
[ "$(wc -l <"$work/start/lanes.csv")" -eq 9 ] || fail "lanes.csv has not four lanes for each population"
grep -q nan "$work/start"/*.csv && fail "a table has nan"
green=$(cell "$work/start/timing.csv" green_s)
cross=$(cell "$work/start/timing.csv" cross_green_s)
grep -qF -- "CTG-Ref: --set 'signal.green=${green%.00} s' --set 'signal.cross_green=${cross%.00} s'" "$work/stdout" ||
    fail "the options do not have the times of timing.csv"
# The cycle is the sum of its parts: two greens, two changes of 8 s.
awk "BEGIN { exit !($green + $cross + 16 == $(cell "$work/start/timing.csv" cycle_s)) }" || fail "the cycle is not the sum"
sed -n '/^CTG-Ref: /,/^$/p' "$work/stdout" | sed '1d;/^$/d' >"$work/signal.yaml"
python3 - "$work/signal.yaml" "$green" <<'PYTHON' || fail "the YAML of the times: $(cat "$work/signal.yaml")"
import sys
lines = open(sys.argv[1]).read().splitlines()
assert lines[0] == "signal:" and f"  green: {float(sys.argv[2]):g} s" in lines, lines
PYTHON
next=$(sed -n '/^Next: run/{n;p}' "$work/stdout")
(cd "$work" && eval "$next --no-figures --set measure.cycles=1 --output $work/applied" >/dev/null 2>"$work/stderr") ||
    fail "the next command fails: $next: $(cat "$work/stderr")"

# Demand that is too high: flow ratios instead of times, exit code 1.
code=0
"$program" "$intersection" "${rate[@]}" --set 'demand.inflow=2400 veh/h' --population CTG-Ref --output "$work/over" \
    >"$work/stdout" 2>"$work/stderr" || code=$?
[ $code -eq 1 ] || fail "too high demand: exit code $code instead of 1"
grep -qF "CTG-Ref: the demand is too high for any cycle" "$work/stdout" || fail "too high demand: no message"
grep -qE "west-east: flow ratio 0\.[0-9]+ on lane west_in_[01], 1200 of [0-9]+ veh/h" "$work/stdout" ||
    fail "too high demand: no flow ratios"
[ -z "$(cell "$work/over/timing.csv" cycle_s)" ] || fail "too high demand: timing.csv has a cycle"

# A search over greens and offsets of a short arterial.
arterial=("$STOPLINE_SOURCE/scenarios/arterial.yaml" --set demand.kind=rate --set 'demand.inflow=500 veh/h'
    --set network.grid.columns=2 --set 'duration=300 s' --set 'measure.window=120 s' --population CTG-Ref --search
    --seeds 2 --greens 3 --offsets 2)
"$program" "${arterial[@]}" --output "$work/search" >"$work/stdout" 2>"$work/stderr" ||
    fail "search: exit code $?: $(cat "$work/stderr")"
for part in "start values" "best" "95 % confidence interval" "--set 'signal.offset=" "--seed 4"; do
    grep -qF -- "$part" "$work/stdout" || fail "search: '$part' is missing"
done
expect_documented "$work/search/timing.csv" signals/timing.csv
expect_documented "$work/search/lanes.csv" signals/lanes.csv
expect_documented "$work/search/search.csv" signals/search.csv
expect_documented "$work/search/search_CTG-Ref.csv" signals/search_POPULATION.csv
settings=$(($(wc -l <"$work/search/search.csv") - 1))
[ $settings -eq 27 ] || [ $settings -eq 18 ] || fail "search: $settings settings"
[ "$(grep -c ',1$' "$work/search/search.csv")" -eq 1 ] || fail "search: the start values are not among the settings"
if command -v gnuplot >/dev/null; then
    [ -s "$work/search/search_CTG-Ref.png" ] || fail "search: there is no figure"
fi
cp "$work/search/search.csv" "$work/first.csv"
"$program" "${arterial[@]}" --no-figures --threads 1 --output "$work/search" >"$work/stdout" || fail "second search: exit code $?"
grep -q "runs were done before" "$work/stdout" || fail "second search: finished runs are repeated"
cmp "$work/first.csv" "$work/search/search.csv" || fail "second search: the table differs"
"$program" "${arterial[@]}" --objective throughput --no-figures --output "$work/search" >"$work/stdout" ||
    fail "throughput: exit code $?"
grep -q "runs were done before" "$work/stdout" || fail "throughput: the runs of the delay are not used"

# refused CASE PART ARGUMENT...: expects exit code 2, PART in the message, and no results
refused() {
    local case_name=$1 part=$2
    shift 2
    local code=0
    "$program" "$@" --output "$work/none" >"$work/stdout" 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] || fail "$case_name: exit code $code instead of 2"
    [ -e "$work/none" ] && fail "$case_name: results are left behind"
    grep -qF -- "$part" "$work/stderr" || fail "$case_name: '$part' is missing in: $(cat "$work/stderr")"
}
line=$(grep -n 'kind: saturated' "$intersection" | cut -d: -f1)
refused "saturated demand" "intersection.yaml:$line:9: field 'demand.kind': value 'saturated'" "$intersection"
refused "override" "--set 'demand.kind=queue': field 'demand.kind'" "$intersection" --set demand.kind=queue \
    --set demand.start=empty
refused "streets" "field 'network.kind': value 'streets'" "$STOPLINE_SOURCE/scenarios/berlin.yaml"
refused "phases" "field 'signal.phases'" "$STOPLINE_SOURCE/scenarios/phases.yaml"
refused "no file" "no scenario given"
refused "missing file" "no such file" "$work/none.yaml"
refused "unknown population" "no population or policy 'CGD'; did you mean 'CDG'" "$intersection" "${rate[@]}" --population CGD
refused "even number of greens" "'4' is even" "$intersection" --search --greens 4
refused "seeds without search" "only with --search" "$intersection" --seeds 4
refused "green without unit" "--min-green: value '5' has no unit" "$intersection" "${rate[@]}" --min-green 5
refused "range" "--range: value '0.5' is not allowed" "$intersection" "${rate[@]}" --search --range 0.5
"$program" --help >"$work/stdout" || fail "--help: exit code $?"
for part in "Examples:" "Next:" "Exit codes: 0 done, 1 " "--search" "--objective"; do
    grep -qF -- "$part" "$work/stdout" || fail "--help: '$part' is missing"
done

exit $((failures > 0))
