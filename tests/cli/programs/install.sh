#!/usr/bin/env bash
# ctest-timeout: 300
# Tests `cmake --install`: each installed program runs in another folder and reads the installed data and scenarios.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"

build="$(dirname "$STOPLINE_BIN")"
cmake --install "$build" --prefix "$work/prefix" >"$work/log" 2>&1 || fail "cmake --install: $(tail -n 3 "$work/log")"
programs=()
for program in "$STOPLINE_BIN"/stopline-*; do
    name=$(basename "$program")
    case "$name" in *_test) continue ;; esac
    programs+=("$name")
    [ -x "$work/prefix/bin/$name" ] || fail "$name was not installed"
done
share="$work/prefix/share/stopline"
data="$share/data"
scenarios="$share/scenarios"
[ -f "$scenarios/first_steps.yaml" ] || fail "the scenarios were not installed"

# The installed data differ from those of the source tree, so results show which of them a program reads.
echo '- {name: INSTALLED, law: constant_distance, standstill_gap: 4 m}' >>"$data/policies/paper.yaml"
sed 's/^name: .*/name: "installed"/' "$data/meso/table2.yaml" >"$data/meso/installed.yaml"
sed -i 's/,117$/,7117/' "$data/startup/kit_curve_leader50.csv"
sed -i 's/^C01,Our fit /C01,Our installed fit /' "$data/paper/explanations.csv"
sed -i 's/,Vehicles past the stop line over time,/,Installed title,/' "$data/paper/figures.csv"
installed_policy=(--set 'populations=[INSTALLED]' --set measure.baseline=INSTALLED)

mkdir "$work/elsewhere"
cd "$work/elsewhere" || exit 1
PATH="$work/prefix/bin:$PATH"
unset STOPLINE_DATA

# runs PART COMMAND...: expects exit code 0 and PART on standard output
runs() {
    local part=$1
    shift
    "$@" >"$work/stdout" 2>"$work/stderr" || fail "$*: exit code $?: $(tail -n 3 "$work/stderr")"
    grep -qF -- "$part" "$work/stdout" || fail "$*: '$part' is missing in the output"
}

# refuses PART COMMAND...: expects exit code 2 and PART in the message
refuses() {
    local part=$1 code=0
    shift
    "$@" >"$work/stdout" 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] || fail "$*: exit code $code instead of 2"
    grep -qF -- "$part" "$work/stderr" || fail "$*: '$part' is missing in: $(head -c 300 "$work/stderr")"
}

# written FILE...: expects each FILE to exist and not to be empty
written() {
    local file
    for file in "$@"; do
        [ -s "$file" ] || fail "$file is missing or empty in the present folder"
    done
}

# Examples in the help of every program name scenarios that exist.
for name in "${programs[@]}"; do
    runs "Examples:" "$name" --help
    grep '^  stopline-' "$work/stdout" | grep -oE '[^ ]*scenarios/[^ ]*[.]yaml' | sort -u >"$work/examples"
    while read -r example; do
        [[ "$example" == "$scenarios"/* && -f "$example" ]] || fail "$name --help: '$example' is no installed scenario"
    done <"$work/examples"
done

runs "INSTALLED" stopline-run --list
runs "INSTALLED" stopline-run "$scenarios/first_steps.yaml" "${installed_policy[@]}" --no-figures --record first.rec
written out/first_steps/summary.csv first.rec
runs "first.html" stopline-replay first.rec
written first.html

cat >short_sweep.yaml <<YAML
scenario: $scenarios/first_steps.yaml
axes: [{name: vehicles, path: demand.vehicles, values: ['2', '3']}]
YAML
runs "out/short_sweep" stopline-sweep short_sweep.yaml "${installed_policy[@]}"
written out/short_sweep/short_sweep.csv
grep -q "INSTALLED" out/short_sweep/short_sweep.csv || fail "stopline-sweep did not run the installed policy"

runs "7117 starts" stopline-startup --no-figures
written out/startup/startup.csv
runs "Our installed fit" stopline-scorecard --section V.A --csv
written out/scorecard/scorecard.csv

cat >short_calibration.yaml <<YAML
scenario: $scenarios/calibration.yaml
axes: [{name: population, populations: [CTG-Ref]}]
YAML
runs "installed" stopline-calibrate short_calibration.yaml --step I --parameters installed
written out/calibration/misses.csv

runs "INSTALLED" stopline-export --sumo sumo "$scenarios/first_steps.yaml" "${installed_policy[@]}"
written sumo/run.sumocfg
# stopline-compare runs only with SUMO, so this test asks for an unknown policy: the message lists the installed ones.
refuses "INSTALLED" stopline-compare "$scenarios/first_steps.yaml" --set 'populations=[UNKNOWN]'

if command -v gnuplot >/dev/null; then
    runs "index.html" stopline-reproduce --section III --quick --output report
    grep -q "Installed title" report/index.html || fail "stopline-reproduce does not read the installed list of figures"
fi
mv "$data/paper/quick.csv" "$work"
refuses "$data/paper/quick.csv" stopline-reproduce --section III --quick --output report

benchmark=(stopline-benchmark --benchmark_filter=batch/16/ --benchmark_min_time=0.01)
runs "batch/16/" "${benchmark[@]}"
mv "$scenarios/single_light.yaml" "$work"
refuses "single_light.yaml" "${benchmark[@]}"

exit $((failures > 0))
