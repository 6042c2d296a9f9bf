#!/usr/bin/env bash
# Tests sentences of the report that stopline-run prints: they agree with the tables, and explain their words.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
run="$STOPLINE_BIN/stopline-run"
scenarios="$STOPLINE_SOURCE/scenarios"

# report NAME COMMAND...: stores the report of a run, as one line with single spaces, in $work/NAME
report() {
    local name=$1
    shift
    "$run" "$@" --no-figures --output "$work/out_$name" >"$work/stdout" 2>"$work/stderr" ||
        fail "$name: exit code $?: $(head -c 300 "$work/stderr")"
    tr -s ' \n' ' ' <"$work/stdout" >"$work/$name"
}
has() { grep -qF -- "$2" "$work/$1" || fail "$1: '$2' is missing in: $(cat "$work/$1")"; }
lacks() { grep -qF -- "$2" "$work/$1" && fail "$1: '$2' is not expected"; }

# Vehicles with different standstill gaps have closed up, and vehicles that still arrive have not.
cat >"$work/mix.yaml" <<'END'
fidelity: meso
network: {approach: {length: 600 m}}
duration: 200 s
signal: {first_green: 120 s, green: 60 s}
demand: {vehicles: 20}
populations:
- CDG
- {name: MIX, pattern: alternating, components: [{policy: CDG, share: 50 %}, {policy: CDG-6m, share: 50 %}]}
measure: {green: [10 s], baseline: CDG}
END
report closed "$work/mix.yaml"
lacks closed "has not closed up"
report open "$work/mix.yaml" --set 'signal.first_green=40 s'
has open "The end of the queue has not closed up when the green starts (largest net gap): CDG"
has open "mean improvement: over all green times from 20 s to 60 s, at most until one of the two queues has emptied;"

# A short grid: with cooperative clearing, refusals belong to the causes of delay and to the uses of the rules.
grid=("$scenarios/grid.yaml" --set network.grid.columns=2 --set network.grid.rows=2 --set 'populations=[CDG]'
    --set measure.baseline=CDG --set 'duration=300 s')
report plain "${grid[@]}"
has plain "The rest of the delay is due to signals, yielding and queue discharge (summary.csv)."
lacks plain "refus"
has plain "semi-stable: gridlocks or teleported vehicles, but all gridlocks dissolve, and less than 1 % of the vehicles"
has plain "the run lasts 300 s: the run is measured from its start, because it is too short to find the end of its warm-up"
report clearing "${grid[@]}" --set rules.clearing=cooperative
has clearing "due to signals, yielding, queue discharge and refusals by cooperative clearing (summary.csv)."
has clearing "teleported blockers refused"
has clearing "refused: number of times that rules.clearing began to hold a vehicle at its stop line"
report long "${grid[@]}" --set 'duration=900 s' --set 'measure.interval=60 s'
has long "the run lasts 900 s: each population is measured from the end of its warm-up."

exit $((failures > 0))
