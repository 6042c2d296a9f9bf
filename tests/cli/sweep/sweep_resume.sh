#!/usr/bin/env bash
# ctest-labels: slow
# Tests that a sweep gives the same bytes after kills and restarts and for any number of threads. A store of another
# scenario or sweep is never continued.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
program="$STOPLINE_BIN/stopline-sweep"

# 40 runs of about 10 ms each.
cat >"$work/short.yaml" <<'YAML'
duration: 600 s
network: {approach: {length: 300 m}}
signal: {first_green: 60 s, green: 30 s}
demand: {vehicles: 20}
populations:
- CDG
- {name: MIX, pattern: random, components: [{policy: CDG, share: 50 %}, {policy: CTG-Ref, share: 50 %}]}
measure: {green: [5 s, 10 s]}
YAML
cat >"$work/sweep.yaml" <<'YAML'
scenario: short.yaml
axes:
- {name: hesitation, path: driver.free_drive.hesitation, values: [0 s, 0.25 s, 0.5 s, 0.75 s, 1 s]}
repetitions: 4
YAML

# sweep FOLDER [OPTION...]: runs the sweep
sweep() {
    local folder=$1
    shift
    "$program" "$work/sweep.yaml" --output "$folder" "$@"
}

# start FOLDER [OPTION...]: starts the sweep in the background and sets `pid`. It does not call sweep(), because a kill
# would then hit the surrounding shell.
start() {
    local folder=$1
    shift
    "$program" "$work/sweep.yaml" --output "$folder" "$@" >/dev/null 2>"$work/stderr" &
    pid=$!
}

# same_table CASE FOLDER: expects the table and the provenance of the undisturbed sweep in FOLDER
same_table() {
    cmp "$work/whole/sweep.csv" "$2/sweep.csv" || fail "$1: the table differs"
    cmp "$work/whole/sweep.provenance.json" "$2/sweep.provenance.json" || fail "$1: the provenance differs"
}

milliseconds() {
    echo $(($(date +%s%N) / 1000000))
}

begin=$(milliseconds)
sweep "$work/whole" --threads 1 >"$work/stdout" || fail "exit code $?"
whole_ms=$(($(milliseconds) - begin))
[ "$(wc -l <"$work/whole/sweep.csv")" -eq 41 ] || fail "the table has not 40 runs: $(wc -l <"$work/whole/sweep.csv") lines"
grep -q "million vehicle updates per second" "$work/stdout" || fail "the speed is missing in: $(cat "$work/stdout")"
[ "$(ls -A "$work/whole")" = "$(printf '%s\n' lines_1.{dat,gp,png,svg} sweep.csv sweep.provenance.json sweep.sqlite sweep_means.csv)" ] ||
    fail "the folder has other files: $(ls -A "$work/whole")"
sweep "$work/two" --threads 2 >/dev/null || fail "exit code $?"
same_table "two threads" "$work/two"
sweep "$work/two" >"$work/stdout" || fail "exit code $?"
grep -q "were done before" "$work/stdout" || fail "finished runs are repeated"

# Repeated kills after random times of up to a quarter of the total time. Each start completes some runs, so the sweep
# ends after some restarts.
kills=0
for _ in $(seq 200); do
    ms=$((RANDOM * whole_ms / 4 / 32768))
    start "$work/killed" --threads 1
    sleep "$(printf '%d.%03d' $((ms / 1000)) $((ms % 1000)))"
    if kill -KILL $pid 2>/dev/null; then
        wait $pid 2>/dev/null
        [ $? -eq 137 ] && kills=$((kills + 1))
    else
        wait $pid
    fi
    [ -e "$work/killed/sweep.csv" ] && break
done
[ -e "$work/killed/sweep.csv" ] || fail "the sweep is not complete after $kills kills: runs are lost"
[ $kills -ge 2 ] || fail "only $kills kills hit a running program"
sweep "$work/killed" >/dev/null || fail "after $kills kills: exit code $?"
same_table "$kills kills" "$work/killed"

# A kill in the middle of the sweep. The test tries several times until the kill, so that one of them suits the speed of
# the machine. Finished runs are not repeated.
now=0
for seconds in 0.7 0.3 2 6 20; do
    rm -rf "$work/once"
    start "$work/once" --threads 1 --set "duration=3000 s"
    sleep $seconds
    kill -KILL $pid 2>/dev/null
    wait $pid 2>/dev/null
    sweep "$work/once" --set "duration=3000 s" >"$work/stdout" || fail "after a kill: exit code $?"
    now=$(sed -n 's/ runs now.*//p' "$work/stdout")
    [ "${now:-0}" -gt 0 ] && [ "$now" -lt 40 ] && break
done
if [ "${now:-0}" -eq 0 ] || [ "$now" -ge 40 ]; then
    fail "after a kill: $now of 40 runs are repeated"
fi

# Ctrl-C gives exit code 130, a message on how to continue, and a usable store.
start "$work/ctrl_c" --threads 1 --set "duration=20000 s"
wait_for [ -s "$work/ctrl_c/sweep.sqlite-wal" ] || fail "there is no store"
kill -INT $pid
code=0
wait $pid || code=$?
[ $code -eq 130 ] || fail "Ctrl-C: exit code $code"
grep -q "of 40 runs are stored; the same command continues" "$work/stderr" || fail "Ctrl-C: $(cat "$work/stderr")"
[ -e "$work/ctrl_c/sweep.csv" ] && fail "Ctrl-C: there is a table of an incomplete sweep"

# On a terminal, the progress bar shows the time left.
if command -v script >/dev/null; then
    on_terminal '40 runs \[[#.]{30}\] +[0-9]+ %, .* left' "$program" "$work/sweep.yaml" --output "$work/bar" --threads 2 \
        --set "duration=60000 s"
fi

# refused CASE PART COMMAND...: expects exit code 2 and PART in the message
refused() {
    local case_name=$1 part=$2
    shift 2
    local code=0
    "$@" >"$work/stdout" 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] || fail "$case_name: exit code $code instead of 2"
    grep -qF -- "$part" "$work/stderr" || fail "$case_name: '$part' is missing in: $(cat "$work/stderr")"
}

refused "other override" "has changed since" sweep "$work/two" --set "signal.yellow=4 s"
refused "other seed" "has changed since" sweep "$work/two" --seed 9
sed -i 's/vehicles: 20/vehicles: 19/' "$work/short.yaml"
refused "changed scenario" "has changed since" sweep "$work/two"
sed -i 's/vehicles: 19/vehicles: 20/' "$work/short.yaml"
sweep "$work/two" >/dev/null || fail "restored scenario: exit code $?"
cp "$work/sweep.yaml" "$work/other.yaml"
cp "$work/two/sweep.sqlite" "$work/two/other.sqlite"
refused "store of another sweep" "of the sweep 'sweep'" "$program" "$work/other.yaml" --output "$work/two"
cp "$program" "$work/rebuilt"
printf '\0' >>"$work/rebuilt"
refused "store of another build" "another build of the program" "$work/rebuilt" "$work/sweep.yaml" --output "$work/two"
echo "no database" >"$work/two/other.sqlite"
refused "file that is not a store" "not a store" "$program" "$work/other.yaml" --output "$work/two"

# A second program must not open a store that is in use.
start "$work/busy" --threads 1 --set "duration=20000 s"
wait_for [ -s "$work/busy/sweep.sqlite-wal" ] || fail "there is no store"
refused "store in use" "another program has this store open" sweep "$work/busy" --set "duration=20000 s"
kill -KILL $pid
wait $pid 2>/dev/null

# A file size limit stands in for a full disk. With free space the sweep continues.
mkdir "$work/full"
(
    ulimit -f 24
    refused "full disk" "$work/full/sweep.sqlite" sweep "$work/full" --threads 1
    exit $((failures > 0))
) || failures=$((failures + 1))
sweep "$work/full" >/dev/null || fail "with free space: exit code $?"
same_table "after a full disk" "$work/full"

exit $((failures > 0))
