#!/bin/bash
# Tests that stopline-run refuses bad input with exit code 2 and a message on standard error with file, place and field.
# It never crashes and never replaces a bad value by another one.
set -u

run="$STOPLINE_BIN/stopline-run"
[ -x "$run" ] || { echo "skipped: there is no $run"; exit 77; }
. "$STOPLINE_SOURCE/tests/tools/cli.sh"
good="$STOPLINE_SOURCE/scenarios/first_steps.yaml"

# refused CASE PART... -- ARGUMENT...: expects exit code 2, nothing on standard output, and each PART in the message
refused() {
    local case_name=$1
    shift
    local parts=()
    while [ "$1" != "--" ]; do
        parts+=("$1")
        shift
    done
    shift
    timeout 60 "$run" --output "$work/out" "$@" >"$work/stdout" 2>"$work/stderr"
    local code=$?
    [ $code -eq 2 ] || fail "$case_name: exit code $code instead of 2"
    [ -s "$work/stdout" ] && fail "$case_name: standard output is not empty: $(head -c 200 "$work/stdout")"
    [ -s "$work/stderr" ] || fail "$case_name: standard error is empty"
    [ -e "$work/out" ] && fail "$case_name: results are left behind"
    local part
    for part in "${parts[@]}"; do
        grep -qF -- "$part" "$work/stderr" || fail "$case_name: '$part' is missing in: $(head -c 500 "$work/stderr")"
    done
}

# refused_text CASE TEXT PART...: does the same as refused, for a scenario file with this TEXT
refused_text() {
    local case_name=$1 text=$2
    shift 2
    printf '%b' "$text" >"$work/bad.yaml"
    refused "$case_name" "$@" -- "$work/bad.yaml"
}

refused_text "unknown field" 'stepp: 10 ms\n' "bad.yaml:1:1" "'stepp'" "did you mean 'step'"
refused_text "duplicate key" 'seed: 1\nseed: 2\n' "bad.yaml:2:1" "'seed' appears twice"
refused_text "missing unit" 'signal:\n  green: 15\n' "bad.yaml:2:10" "'signal.green'" "'15' has no unit" "15 s"
refused_text "wrong unit" 'signal: {green: 15 m}\n' "'signal.green'" "a time is needed"
refused_text "wrong type" 'signal: 15 s\n' "'signal'" "needs a map of fields"
refused_text "negative length" 'network: {approach: {length: -700 m}}\n' "'network.approach.length'" "out of range"
refused_text "leading zero" 'demand: {vehicles: 010}\n' "'demand.vehicles'" "'010' begins with 0"
refused_text "not a number" 'duration: nan\n' "'duration'" "not a finite number"
refused_text "infinity" 'duration: .inf\n' "'duration'" "not a finite number"
refused_text "unknown policy" 'populations: [CDG, CGT-Ref]\n' "'CGT-Ref'" "did you mean 'CTG-Ref'"
refused_text "unknown vehicle" 'vehicle: petrol\n' "'vehicle'" "petrol_eu4_72kw"
refused_text "empty file" '' "bad.yaml:1:1" "is empty"
refused_text "comment only" '# nothing\n' "is empty"
refused_text "broken YAML" 'signal: [15 s\n' "bad.yaml" "not valid YAML"
refused_text "quote without end" 'seed: 2\ntitle: "abc\nseed: 5\n' "bad.yaml:2:8" 'begins with the quote " but has no closing quote'
refused_text "tab" 'signal:\n\tgreen: 20 s\n' "bad.yaml:2:7" "the line begins with a tab; use spaces"
refused_text "share without unit" 'demand: {left: 1}\n' "bad.yaml:1:16" "write '1 %' or '100 %', whichever is meant"
refused_text "field without effect" 'measure: {window: 60 s}\n' "bad.yaml:1:19" "'measure.window'" "networks of several"
refused_text "part of a vehicle" 'vehicle: {mass: 1700 kg}\n' "bad.yaml:1:10" "add 'base: NAME'"
refused_text "endless anchor" 'title: &a [*a]\n' "inside its own anchor"
refused_text "NUL byte" 'title: a\0b\n' "bad.yaml:1:9" "0x00"
refused_text "broken UTF-8" 'title: \xc3\x28\n' "bad.yaml:1:8" "0xC3"
refused_text "approach too short for the queue" 'network: {approach: {length: 50 m}}\n' "'network.approach.length'" "a queue of 60 vehicles"

# Spacing laws that the policy itself defines. Each message names the term that is wrong.
law() { printf '%s' "policies:\n- {name: P, law: formula, standstill_gap: 3 m, gap: $1}\npopulations: [P]\n"; }
refused_text "unit of a term" "$(law '"s0 + 0.4 m * v"')" "bad.yaml:2:53" "policies[P].gap" "'0.4 m * v' has the unit m2/s"
refused_text "unknown symbol" "$(law '"s0 + speed"')" "bad.yaml:2:53" "there is no 'speed'" "v (speed)"
refused_text "gap that falls" "$(law '"s0 - 0.1 s * v"')" "the gap falls near"
refused_text "gap that jumps" "$(law '"if(v < 5 m/s, s0, 9 m)"')" "may not jump"
refused_text "gap at rest" "$(law '"2 m + 1 s * v"')" "standstill_gap is 3 m"
refused_text "no model for the mesoscale mode" "$(law '"s0 + 1 s * v"')fidelity: meso\n" "policies[P].mesoscale" "constant_distance, time_gap, idm"
refused_text "table that falls" 'policies:\n- {name: P, law: table, standstill_gap: 3 m, gaps: {50 km/h: 2 m}}\npopulations: [P]\n' \
    "bad.yaml:2:52" "the gap falls"
refused_text "formula of another law" 'policies:\n- {name: P, law: constant_distance, standstill_gap: 3 m, gap: s0}\npopulations: [P]\n' \
    "policies[P].gap" "only if law is formula"

intersection='network: {kind: intersection}\nsignal: {green: 15 s}\nmeasure: {cycles: 20}\n'
refused_text "cycles that contradict the duration" "${intersection}duration: 400 s\n" "bad.yaml:3:19" "measure.cycles" \
    "20 cycles contradict the duration of 400 s" "give only one of the two fields"

refused_text "name of the parent folder" 'populations: [{name: .., components: [{policy: CDG, share: 100 %}]}]\n' \
    "'populations[0].name'" "'..' cannot be used as a name"

laughs='a0: &a0 [x, x, x, x, x, x, x, x, x, x]\n'
for i in 1 2 3 4 5 6 7 8 9; do
    below="*a$((i - 1))"
    laughs+="a$i: &a$i [$below, $below, $below, $below, $below, $below, $below, $below, $below, $below]\n"
done
refused_text "billion laughs" "$laughs" "more than 200000 values"
refused_text "many brackets" "$(printf '[%.0s' $(seq 100000))" "more than 1000 brackets are open here"
refused_text "deep nesting" "$(printf '[%.0s' $(seq 100))" "levels deep"

head -c 104857600 /dev/urandom >"$work/garbage.yaml"
refused "100 MB of garbage" "garbage.yaml" "100.0 MB" -- "$work/garbage.yaml"
head -c 1000000 "$work/garbage.yaml" >"$work/small_garbage.yaml"
refused "1 MB of garbage" "small_garbage.yaml" -- "$work/small_garbage.yaml"

refused "duration shorter than a cycle" "'duration'" "no whole cycle" -- \
    "$STOPLINE_SOURCE/scenarios/intersection.yaml" --set 'duration=10 s'

refused "directory" "is a directory" -- "$work"
refused "missing file" "no such file" -- "$work/none.yaml"
refused "device" "not a file that can be read" -- /dev/zero
if [ "$(id -u)" -ne 0 ]; then
    cp "$good" "$work/secret.yaml"
    chmod 000 "$work/secret.yaml"
    refused "unreadable file" "cannot be opened" -- "$work/secret.yaml"
fi

{
    cat "$good"
    printf '\ndriver:\n  base: startup_kit\n  v2v:\n    channel: delivery_over_distance\n    delivery: nowhere\n'
} >"$work/delivery.yaml"
line=$(grep -n 'delivery: nowhere' "$work/delivery.yaml" | cut -d: -f1)
refused "missing delivery file" "delivery.yaml:$line" "'driver.v2v.delivery'" "there is no 'nowhere'" \
    "known: cv2x_2_subchannels" -- "$work/delivery.yaml"

refused "override without unit" "--set 'signal.green=20'" "'signal.green'" "20 s" -- "$good" --set signal.green=20
refused "override of an unknown field" "did you mean 'green'" -- "$good" --set 'signal.gren=20 s'
refused "override without value" "path=value" -- "$good" --set signal.green
refused "override of a missing entry" "no entry [7]" -- "$good" --set 'populations[7].name=x'
refused "no file" "" --
refused "unknown option" "" -- "$good" --no-such-option

[ $failures -eq 0 ] && echo "all bad input was refused"
[ $failures -eq 0 ]
