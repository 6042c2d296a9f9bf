#!/usr/bin/env bash
# ctest-labels: slow
# Tests stopline-calibrate: both steps on small sweeps, equal files after a kill and a restart, and refusal of bad
# input.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
program="$STOPLINE_BIN/stopline-calibrate"

cat >"$work/timing.yaml" <<YAML
scenario: $STOPLINE_SOURCE/scenarios/calibration.yaml
axes:
- {name: green, path: signal.green, values: [10 s, 20 s, 30 s]}
- {name: population, populations: [CTG-Ref, CDG]}
YAML
cat >"$work/metrics.yaml" <<YAML
scenario: $STOPLINE_SOURCE/scenarios/intersection.yaml
axes:
- {name: step, path: step, values: [20 ms]}
- {name: left, path: demand.left, values: [0 %, 15 %]}
- {name: population, populations: [CDG]}
repetitions: 3
YAML

# fit FOLDER [OPTION...]: runs step I
fit() {
    local folder=$1
    shift
    "$program" "$work/timing.yaml" --step I --starts 1 --evaluations-apart 30 --evaluations 30 --output "$folder" "$@"
}

fit "$work/whole" >"$work/stdout" 2>"$work/stderr" || fail "exit code $?: $(cat "$work/stderr")"
grep -q "held out" "$work/stdout" || fail "held-out permutations are missing in: $(cat "$work/stdout")"
for file in fitted.yaml permutations.csv differences.csv misses.csv fit_history.csv; do
    [ -s "$work/whole/$file" ] || fail "$file is missing or empty"
done

for file in permutations differences misses fit_history; do
    expect_documented "$work/whole/$file.csv" "calibrate/$file.csv"
done

# A kill in the middle of the fit.
"$program" "$work/timing.yaml" --step I --starts 1 --evaluations-apart 30 --evaluations 30 --output "$work/killed" \
    >/dev/null 2>&1 &
pid=$!
wait_for [ -s "$work/killed/fit.sqlite-wal" ]
sleep 0.2
kill -KILL $pid 2>/dev/null
wait $pid 2>/dev/null
fit "$work/killed" --threads 1 >/dev/null 2>"$work/stderr" || fail "after a kill: exit code $?: $(cat "$work/stderr")"
for file in fitted.yaml permutations.csv differences.csv misses.csv fit_history.csv; do
    cmp "$work/whole/$file" "$work/killed/$file" || fail "after a kill: $file differs"
done

# Step II with the parameters of the fit.
"$program" --step II --metrics-sweep "$work/metrics.yaml" --parameters "$work/whole/fitted.yaml" --output "$work/two" \
    >"$work/stdout" 2>"$work/stderr" || fail "step II: exit code $?: $(cat "$work/stderr")"
grep -q "throughput_veh_h" "$work/stdout" || fail "no metric bands in: $(cat "$work/stdout")"
expect_documented "$work/two/bands_calibrated.csv" calibrate/bands_NAME.csv
[ "$(wc -l <"$work/two/bands_calibrated.csv")" -eq 7 ] || fail "bands_calibrated.csv has not 6 rows, for 2 permutations and 3 metrics"

# refused PART OPTION...: expects exit code 2 and PART in the message
refused() {
    local part=$1 code=0
    shift
    rm -rf "$work/bad"
    "$program" --output "$work/bad" "$@" >"$work/stdout" 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] || fail "$*: exit code $code instead of 2"
    grep -qF -- "$part" "$work/stderr" || fail "$*: '$part' is missing in: $(cat "$work/stderr")"
    grep -qE "^(full dynamics|mesoscale mode)" "$work/stdout" && fail "$*: refused only after runs"
}
refused "nonsense" "$work/timing.yaml" --step I --start nonsense
refused "accepted" "$work/timing.yaml" --step I --accepted "$work/timing.yaml"
# accepted PERMUTATION DETECTOR: writes a file with one accepted difference
accepted() {
    printf 'accepted:\n- {permutation: "%s", detector: "%s", reason: none}\n' "$1" "$2" >"$work/accepted.yaml"
}
permutation="green = 10 s, population = CDG"
first_detector='import csv, sys; print(next(csv.DictReader(open(sys.argv[1])))["detector"])'
detector="$(python3 -c "$first_detector" "$work/whole/differences.csv")"
with_parameters=("$work/timing.yaml" --step I --parameters "$work/whole/fitted.yaml" --accepted "$work/accepted.yaml")
accepted "$permutation" foo
refused "accepted.yaml:2:61: field 'accepted[0].detector': there is no detector 'foo'" "${with_parameters[@]}"
grep -q "full dynamics:" "$work/stdout" && fail "the names of --accepted are checked after the runs"
accepted "green = 11 s, population = CDG" "$detector"
refused "there is no permutation 'green = 11 s, population = CDG'; did you mean '$permutation'? Known: 'green = 10 s, population = CTG-Ref', '" "${with_parameters[@]}"
grep -qF "accepted.yaml:2:17: field 'accepted[0].permutation'" "$work/stderr" || fail "no place in: $(cat "$work/stderr")"
accepted "$permutation" "$detector"
"$program" --output "$work/accepted" "${with_parameters[@]}" >"$work/stdout" 2>"$work/stderr" ||
    fail "known names are refused: $(cat "$work/stderr")"
sed 's/repetitions: 3/repetitions: 2/' "$work/metrics.yaml" >"$work/few.yaml"
# Step II is checked before the first run, also if step I comes first.
timing=()
for step in II both; do
    refused "few.yaml:6:14: field 'repetitions': value 2 is too small: a confidence band needs at least 3 runs" \
        "${timing[@]}" --step $step --metrics-sweep "$work/few.yaml" --parameters fitted
    refused "no result 'throughput_veh'; did you mean 'throughput_veh_h'? Known: " \
        "${timing[@]}" --step $step --metrics-sweep "$work/metrics.yaml" --parameters fitted --metric throughput_veh
    refused "no result 'state_hash'" \
        "${timing[@]}" --step $step --metrics-sweep "$work/metrics.yaml" --parameters fitted --metric state_hash
    grep -qE "state_hash,|population,|seed," "$work/stderr" && fail "columns without mean in: $(cat "$work/stderr")"
    timing=("$work/timing.yaml")
done

exit $((failures > 0))
