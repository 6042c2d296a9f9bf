#!/usr/bin/env bash
# Tests that no program overwrites its own input or writes two outputs to one file, and that values without effect are
# refused or give a warning.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
cp "$STOPLINE_SOURCE/scenarios/first_steps.yaml" "$work/one.yaml"
cd "$work" || exit 1
one=(--set 'populations=[CDG]' --set measure.baseline=CDG --no-figures)

# refused PART PROGRAM [ARGUMENT...]: expects exit code 2, PART in the message, and no output
refused() {
    local part=$1 program=$2 code=0
    shift 2
    "$STOPLINE_BIN/stopline-$program" "$@" >stdout 2>stderr || code=$?
    [ $code -eq 2 ] || fail "$program $*: exit code $code instead of 2"
    grep -qF -- "$part" stderr || fail "$program $*: '$part' is missing in: $(head -c 400 stderr)"
    [ -s stdout ] && fail "$program $*: standard output is not empty: $(head -n 3 stdout)"
    [ -e out ] && fail "$program $*: results are left behind"
    rm -rf out
}

# An output that is an input, also through another spelling, a link or the default name.
refused "'one.yaml' (--record) would overwrite 'one.yaml' (the scenario)" run one.yaml "${one[@]}" --record one.yaml
ln -s one.yaml link.xml
refused "(--fcd) would overwrite 'one.yaml' (the scenario)" run one.yaml "${one[@]}" --fcd ../"$(basename "$work")"/link.xml
cp "$STOPLINE_SOURCE/data/vehicles/electric_100kw.yaml" car.yaml
refused "(a file that the scenario names)" run one.yaml "${one[@]}" --set vehicle=./car.yaml --tripinfo car.yaml
cmp one.yaml "$STOPLINE_SOURCE/scenarios/first_steps.yaml" || fail "the scenario was overwritten"
"$STOPLINE_BIN/stopline-run" one.yaml "${one[@]}" --record g.rec --output results >/dev/null || fail "exit code $?"
cp g.rec copy.rec
refused "'g.rec' (--output) would overwrite 'g.rec' (the recording)" replay g.rec --output g.rec
ln -s g.rec g.html
refused "would overwrite 'g.rec' (the recording)" replay g.rec
cmp g.rec copy.rec || fail "the recording was overwritten"
cp "$STOPLINE_SOURCE/data/startup/kit_curve.csv" starts.csv
refused "(--write) would overwrite 'starts.csv' (--measured)" startup --fit --measured starts.csv --write starts.csv
refused "(--markdown) would overwrite" scorecard --markdown "$STOPLINE_SOURCE/data/paper/targets.csv"
cp "$STOPLINE_SOURCE/data/meso/table2.yaml" fitted.yaml
refused "would overwrite 'fitted.yaml' (--start)" calibrate --start fitted.yaml --output .

# Two outputs in one file.
refused "'./X' (--tripinfo) would overwrite 'X' (--fcd)" run one.yaml "${one[@]}" --fcd X --tripinfo ./X
refused "would overwrite 'X.CDG' (--fcd)" run one.yaml --no-figures --fcd X --tripinfo X
refused "(--trajectories-file) would overwrite 'out/one/summary.csv' (a table in the folder of --output)" \
    run one.yaml "${one[@]}" --trajectories --trajectories-file summary.csv
refused "(a table in the folder of --output)" run one.yaml "${one[@]}" --output r --fcd r/one.provenance.json
refused "a figure in the folder of --output could overwrite 'r/platoon.svg'" \
    run one.yaml --set 'populations=[CDG]' --set measure.baseline=CDG --output r --fcd r/platoon.svg
refused "so the name 'counters.svg' must end with .csv or .csv.gz or .csv.zst" \
    run one.yaml "${one[@]}" --trajectories --trajectories-file counters.svg
refused "so the name 'a.parquet' must end with .csv" run one.yaml "${one[@]}" --trajectories --trajectories-file a.parquet
for outside in ../a.csv b/../../a.csv "$PWD/a.csv"; do
    refused "'$outside' is outside of the results folder" run one.yaml "${one[@]}" --trajectories --trajectories-file "$outside"
done
refused "have no effect on --trajectories here" run one.yaml "${one[@]}" --trajectories --record-from '10 s'
refused "would overwrite 's/scorecard.csv'" scorecard --output s --markdown s/scorecard.csv
"$STOPLINE_BIN/stopline-run" one.yaml "${one[@]}" --fcd /dev/null --tripinfo /dev/null --output null >/dev/null ||
    fail "two outputs to /dev/null: exit code $?"

# Outputs that cannot be written are reported before the work.
mkdir folder
refused "folder: cannot write: Is a directory" startup --fit --write folder
refused "folder: cannot write: Is a directory" scorecard --markdown folder
refused "folder: cannot write: Is a directory" run one.yaml "${one[@]}" --set "duration=1000000 s" --record folder
refused "is a folder; add the name" run one.yaml "${one[@]}" --e1 folder/

# Empty texts.
for option in --output --set --record --trajectories-file --interval; do
    refused "$option: the value is empty" run one.yaml $option ''
done
refused "FILE: the value is empty" run ''
refused "--sumo: the value is empty" export one.yaml --sumo ''
refused "--section: the value is empty" scorecard --section ''
refused "--section: the value is empty" reproduce --section ''
refused "--section" reproduce --section=
refused "--population: the value is empty" strings --population ''
refused "--shard: the value is empty" sweep one.yaml --shard ''
refused "STORE: the value is empty" sweep merge --output merged ''

# Options without the option to which they belong.
refused "--trajectories-file has an effect only with --trajectories" run one.yaml --trajectories-file a.csv
refused "--interval has an effect only with --trajectories" run one.yaml --interval '1 s'
refused "--record-interval has an effect only with --record or --fcd" run one.yaml --record-interval '2 s'
refused "--record-from has an effect only with --record or --fcd or --trajectories" run one.yaml --record-from '2 s'
refused "--e1-interval has an effect only with --e1" run one.yaml --e1-interval '60 s'
refused "--write has an effect only with --fit" startup --write driver.yaml
refused "--seeds has an effect only with --search" signals "$STOPLINE_SOURCE/scenarios/intersection.yaml" --seeds 4
refused "--metric has no effect with --step I" calibrate --step I --metric throughput_veh_h
refused "--starts has no effect with --parameters" calibrate --parameters table2 --starts 2
refused "SWEEP has no effect with --step II" calibrate --step II some.yaml
refused "--output before 'merge' has no effect" sweep --output a merge --output b c.sqlite

# Settings that are replaced.
refused "--seed and --set 'seed=...' both set the seed" run one.yaml --seed 2 --set seed=3
"$STOPLINE_BIN/stopline-run" one.yaml "${one[@]}" --set 'vehicle.mass=1 t' --set vehicle=electric_100kw --output w \
    >/dev/null 2>stderr || fail "exit code $?"
grep -qF "warning: --set 'vehicle.mass=1 t': has no effect, because the later --set 'vehicle=electric_100kw' replaces it" \
    stderr || fail "a replaced setting: $(cat stderr)"

exit $((failures > 0))
