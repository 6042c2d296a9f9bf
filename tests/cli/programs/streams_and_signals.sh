#!/usr/bin/env bash
# Tests closed and full standard streams, signals, closed pipes and too little memory: every program ends with its
# documented exit code, and no temporary file is left.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
run="$STOPLINE_BIN/stopline-run"
scenario="$STOPLINE_SOURCE/scenarios/first_steps.yaml"
endless=(--set "duration=1000000 s" --no-figures --threads 2)

# Closed streams count as /dev/null.
for program in "$STOPLINE_BIN"/stopline-*; do
    case $program in *_test) continue ;; esac
    "$program" --help >&- 2>&- <&- || fail "${program##*/} --help with closed streams: exit code $?"
    code=0
    "$program" --nonsense >&- 2>&- <&- || code=$?
    [ $code -eq 2 ] || fail "${program##*/} --nonsense with closed streams: exit code $code"
done
"$run" "$scenario" --no-figures --output "$work/open" >/dev/null || fail "exit code $?"
"$run" "$scenario" --no-figures --output "$work/closed" >&- 2>&- <&- || fail "closed streams: exit code $?"
for file in "$work"/open/*.csv; do
    cmp "$file" "$work/closed/${file##*/}" || fail "closed streams: ${file##*/} differs"
done
if command -v gnuplot >/dev/null; then
    "$run" "$scenario" --output "$work/drawn" >&- 2>&- <&- || fail "figures with closed streams: exit code $?"
    [ -s "$work/drawn/counters.svg" ] || fail "figures with closed streams: there are none"
fi

# A message that cannot be written does not change the exit code.
if [ -e /dev/full ]; then
    code=0
    "$run" none.yaml 2>/dev/full || code=$?
    [ $code -eq 2 ] || fail "standard error on a full disk: exit code $code"
    "$run" "$scenario" --set seed=1 --set seed=2 --no-figures --output "$work/full" >/dev/null 2>/dev/full ||
        fail "a warning on a full disk: exit code $?"
fi

# The reader of a pipe ends early. The program ends like other filters, and leaves no temporary file.
"$STOPLINE_BIN/stopline-run" --describe | head -n 1 >/dev/null
code=${PIPESTATUS[0]}
[ "$code" -eq 141 ] || [ "$code" -eq 0 ] || fail "closed pipe: exit code $code"

# SIGTERM and SIGHUP end a program as Ctrl-C does.
for case in INT:130 TERM:143 HUP:129; do
    signal=${case%:*}
    code=0
    timeout --preserve-status --signal="$signal" 2 "$run" "$scenario" "${endless[@]}" --output "$work/$signal" \
        --record "$work/$signal/x.rec" >"$work/stdout" 2>"$work/stderr" || code=$?
    [ $code -eq "${case#*:}" ] || fail "SIG$signal: exit code $code"
    grep -q "interrupted; all files on disk are complete" "$work/stderr" || fail "SIG$signal: $(cat "$work/stderr")"
    [ -z "$(ls -A "$work/$signal")" ] || fail "SIG$signal: files are left: $(ls -A "$work/$signal")"
done
cat >"$work/sweep.yaml" <<YAML
scenario: $scenario
axes:
- {name: hesitation, path: driver.free_drive.hesitation, values: [0 s, 0.5 s]}
repetitions: 4
YAML
"$STOPLINE_BIN/stopline-sweep" "$work/sweep.yaml" --set "duration=20000 s" --threads 1 --output "$work/swept" \
    >/dev/null 2>"$work/stderr" &
pid=$!
wait_for [ -s "$work/swept/sweep.sqlite-wal" ] || fail "there is no store"
kill -TERM $pid
code=0
wait $pid || code=$?
[ $code -eq 143 ] || fail "SIGTERM during a sweep: exit code $code"
grep -q "of 16 runs are stored; the same command continues" "$work/stderr" || fail "SIGTERM during a sweep: $(cat "$work/stderr")"
[ -e "$work/swept/sweep.sqlite-wal" ] && fail "SIGTERM during a sweep: the store was not closed"

# A message to a closed pipe does not end the program.
{
    sleep 1
    "$run" "$scenario" --set seed=1 --set seed=2 --no-figures --output "$work/pipe" 2>&1 >/dev/null
    echo $? >"$work/code"
} | { exec <&-; sleep 1; }
wait_for [ -s "$work/code" ] || fail "the program did not end"
[ "$(cat "$work/code")" -eq 0 ] || fail "a message to a closed pipe: exit code $(cat "$work/code")"

# A program that nohup starts ignores SIGHUP.
(
    trap '' HUP
    exec "$run" "$scenario" "${endless[@]}" --output "$work/nohup"
) >/dev/null 2>&1 &
pid=$!
sleep 1
kill -HUP $pid
sleep 1
kill -TERM $pid || fail "ignored SIGHUP: the program has ended"
code=0
wait $pid || code=$?
[ $code -eq 143 ] || fail "ignored SIGHUP: exit code $code"

# Too little memory: the message names the input. The address sanitizer itself needs more memory than these limits.
limits=(100000 400000)
grep -q __asan_init "$run" && limits=()
grid=(--set network.grid.columns=100 --set network.grid.rows=100 --threads 1 --no-figures --output "$work/memory")
for kilobytes in "${limits[@]}"; do
    code=0
    (ulimit -v "$kilobytes" && exec "$run" "$STOPLINE_SOURCE/scenarios/grid.yaml" "${grid[@]}") >/dev/null 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] || fail "$kilobytes kB: exit code $code"
    grep -q "scenarios/grid.yaml: not enough memory" "$work/stderr" || fail "$kilobytes kB: $(cat "$work/stderr")"
done

# A figure that cannot be written leaves no part of a picture.
if command -v gnuplot >/dev/null; then
    code=0
    (ulimit -f 8 && exec "$STOPLINE_BIN/stopline-startup" --output "$work/small") >/dev/null 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] || fail "figure on a full disk: exit code $code"
    [ -z "$(find "$work/small" -name '*.part')" ] || fail "figure on a full disk: $(ls -A "$work/small")"
fi

exit $((failures > 0))
