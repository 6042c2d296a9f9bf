#!/usr/bin/env bash
# Tests the help of stopline-sweep, and that bad input gives exit code 2 and a message before any run starts.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
program="$STOPLINE_BIN/stopline-sweep"
good="$STOPLINE_SOURCE/scenarios/sweeps/single_light.yaml"
cp "$STOPLINE_SOURCE/scenarios/first_steps.yaml" "$work/short.yaml"

# refused CASE PART... -- ARGUMENT...: expects exit code 2, each PART in the message, no standard output, and no results
refused() {
    local case_name=$1
    shift
    local parts=()
    while [ "$1" != "--" ]; do
        parts+=("$1")
        shift
    done
    shift
    local code=0
    timeout 60 "$program" --output "$work/out" "$@" >"$work/stdout" 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] || fail "$case_name: exit code $code instead of 2"
    [ -s "$work/stdout" ] && fail "$case_name: standard output is not empty: $(head -c 200 "$work/stdout")"
    [ -e "$work/out" ] && fail "$case_name: results are left behind"
    local part
    for part in "${parts[@]}"; do
        grep -qF -- "$part" "$work/stderr" || fail "$case_name: '$part' is missing in: $(head -c 500 "$work/stderr")"
    done
}

# refused_text CASE TEXT PART...: does the same as refused, for a sweep file with this TEXT
refused_text() {
    local case_name=$1 text=$2
    shift 2
    printf '%b' "$text" >"$work/bad.yaml"
    refused "$case_name" "$@" -- "$work/bad.yaml"
}

# refused_axis CASE AXIS PART...: does the same as refused, for a sweep with one AXIS, in line 3 of the file
refused_axis() {
    local case_name=$1 axis=$2
    shift 2
    refused_text "$case_name" "scenario: short.yaml\naxes:\n- $axis\n" "$@"
}

refused_text "empty file" '' "bad.yaml:1:1" "needs a map of fields"
refused_text "broken YAML" 'axes: [\n' "not valid YAML"
refused_text "scenario instead of a sweep" 'signal: {green: 5 s}\n' "bad.yaml:1:1" "'signal' is unknown" "field 'scenario' is missing"
refused_text "missing scenario" 'scenario: none.yaml\n' "bad.yaml:1:11" "'scenario'" "none.yaml: no such file"
refused_text "bad scenario" 'scenario: bad.yaml\n' "field 'scenario' is unknown"
refused_text "zero repetitions" 'scenario: short.yaml\nrepetitions: 0\n' "bad.yaml:2:14" "'repetitions'" "1 to 1000000"
refused_axis "unknown path" '{name: a, path: signal.gren, values: [5 s]}' "bad.yaml:3:19" "did you mean 'green'"
refused_axis "axis without values" '{name: a, path: signal.green}' "bad.yaml:3:3" "axes[a]" "no values"
refused_axis "axis with an empty list" '{name: a, path: signal.green, values: []}' "axes[a].values" "has 0 entries"
refused_axis "value without unit" '{name: a, path: signal.green, values: [9 s, 5]}' "bad.yaml:3:47" "'5' has no unit" "5 s"
refused_axis "value out of range" '{name: a, path: demand.vehicles, values: [0]}' "'0' is out of range" "1 to 100000"
refused_axis "unknown vehicle" '{name: a, path: vehicle, values: [petrol]}' "bad.yaml:3:37: " "a = petrol" "there is no 'petrol'"
refused_axis "unknown population" '{name: a, populations: [CDG, CGT-Ref]}' "bad.yaml:3:32: " "no population 'CGT-Ref'"
refused_axis "unknown policy" "{name: a, path: 'policies[CGT].time_gap', values: [1 s]}" "a = 1 s" "no entry [CGT]"
refused_axis "value that violates a check" '{name: a, path: signal.green, values: [20 s, 9 s]}' "bad.yaml:3:48: " "with a = 9 s" \
    "measure.green[1]"
refused_axis "same value in another unit" '{name: a, path: signal.green, values: [60 s, 1 min]}' "bad.yaml:3:48" \
    "'1 min' is the same value as '60 s'"
refused_axis "name of a result column" '{name: queue_emptied, path: signal.green, values: [15 s]}' "bad.yaml:3:10" \
    "axes[queue_emptied].name" "'queue_emptied_s'"
refused_axis "seed as an axis" '{name: a, path: seed, values: [1, 2]}' "write 'repetitions'"

values='1, 2, 3, 4, 5, 6, 7, 8, 9, 10'
axes='scenario: short.yaml\naxes:\n'
fields=(demand.vehicles signal.green signal.yellow signal.all_red network.approach.length network.approach.exit_length
    demand.entry_speed vehicle.mass vehicle.length driver.cacc.v2v_delay driver.cacc.radar_delay
    driver.free_drive.hesitation)
units=("" " s" " s" " s" "00 m" "00 m" " km/h" "000 kg" " m" "0 ms" "0 ms" " s")
for i in "${!fields[@]}"; do
    axes+="- {name: a$i, path: ${fields[$i]}, values: [${values//,/${units[$i]},}${units[$i]}]}\n"
done
refused_text "10^12 permutations" "$axes" "bad.yaml: " "more than 10000000 runs"

refused "shard 5/4" "'5/4' must be K/N" -- "$good" --shard 5/4
refused "shard 0/4" "'0/4' must be K/N" -- "$good" --shard 0/4
refused "shard without numbers" "must be K/N" -- "$good" --shard one
refused "directory" "is a directory" -- "$work"
refused "missing file" "no such file" -- "$work/none.yaml"
refused "override of an axis" "'vehicle' is an axis of the sweep" -- "$good" --set vehicle=electric_100kw
refused "unknown override" "did you mean 'green'" -- "$good" --set "signal.gren=5 s"
refused "no file given" "no sweep file given" --
refused "unknown option" "--nonsense" -- "$good" --nonsense
refused "two files" "two.yaml" -- "$good" two.yaml
refused "merge without stores" "STORE is required" -- merge --output "$work/merged"

# prints PART... -- ARGUMENT...: expects exit code 0, nothing on standard error, and each PART on standard output
prints() {
    local parts=()
    while [ "$1" != "--" ]; do
        parts+=("$1")
        shift
    done
    shift
    "$program" "$@" >"$work/stdout" 2>"$work/stderr" || fail "$*: exit code $?"
    [ -s "$work/stderr" ] && fail "$*: standard error is not empty: $(head -c 300 "$work/stderr")"
    local part
    for part in "${parts[@]}"; do
        grep -qF -- "$part" "$work/stdout" || fail "$*: '$part' is missing in the output"
    done
}

prints "--shard" "--threads" "--seed" "--output" "merge" "Examples:" "mpirun" "Next:" "Exit codes: 0 done, 1 " -- --help
prints "STORE" "--output" -- merge --help
prints "stopline 0." -- --version
prints "repetitions" "populations" "a | b" -- --describe
prints "point,hesitation_s,vehicle,population,seed" "17,1,electric_100kw,CTG-Ref,1" -- "$good" --list
prints "point,hesitation_s" "17,1,electric" -- "$good" --list --shard 2/2
[ "$(wc -l <"$work/stdout")" -eq 10 ] || fail "--list of half a sweep has $(wc -l <"$work/stdout") lines"

exit $((failures > 0))
