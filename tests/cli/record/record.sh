#!/usr/bin/env bash
# Tests recordings and replay pages: each is complete or absent and has the same bytes in every run. Errors give exit
# code 2.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
run="$STOPLINE_BIN/stopline-run"
replay="$STOPLINE_BIN/stopline-replay"
grid=("$STOPLINE_SOURCE/scenarios/grid.yaml" --set network.grid.columns=2 --set network.grid.rows=2 --set "duration=120 s"
    --set "measure.window=60 s" --no-figures --output "$work/out")

# refused PART COMMAND...: expects exit code 2, PART in the message, and nothing on standard output
refused() {
    local part=$1 code=0
    shift
    "$@" >"$work/stdout" 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] || fail "$*: exit code $code instead of 2"
    grep -qF -- "$part" "$work/stderr" || fail "$*: '$part' is missing in: $(head -c 500 "$work/stderr")"
    [ -s "$work/stdout" ] && fail "$*: standard output is not empty: $(head -n 3 "$work/stdout")"
}

"$run" "${grid[@]}" --threads 2 --record "$work/a.rec" >"$work/table" || fail "exit code $?"
grep -qF "bytes per vehicle and frame" "$work/table" || fail "the size per vehicle and frame is missing in: $(cat "$work/table")"
"$run" "${grid[@]}" --threads 1 --record "$work/b.rec" >"$work/table" || fail "exit code $?"
for population in CDG MIX CTG-Ref; do
    cmp "$work/a.$population.rec" "$work/b.$population.rec" || fail "$population: the bytes depend on the number of threads"
done

# same_bytes NAME THREADS RUN_ARGUMENT...: expects that a recording has the same bytes on one and on several threads
same_bytes() {
    local name=$1 threads=$2
    shift 2
    for count in 1 "$threads"; do
        "$run" "$@" --set 'populations=[CDG]' --set measure.baseline=CDG --no-figures --output "$work/out" \
            --threads "$count" --record "$work/$name.$count.rec" >"$work/table" || fail "$name on $count threads: exit code $?"
    done
    cmp "$work/$name.1.rec" "$work/$name.$threads.rec" || fail "$name: the bytes depend on the number of threads"
}
same_bytes grid 3 "$STOPLINE_SOURCE/scenarios/grid.yaml" --set "duration=300 s" --set "measure.window=100 s"
same_bytes grid_full 2 "$STOPLINE_SOURCE/scenarios/grid.yaml" --set "fidelity=full" --set "duration=120 s" \
    --set "measure.window=60 s"
same_bytes streets 3 "$STOPLINE_SOURCE/scenarios/berlin.yaml" --set "duration=300 s" --set "measure.window=100 s" \
    --set "driver.lane_change.gap_opening=cooperative"

"$run" "$STOPLINE_SOURCE/scenarios/first_steps.yaml" --set 'populations=[CDG]' --set measure.baseline=CDG --no-figures \
    --output "$work/out" --record "$work/light.rec" >"$work/table" || fail "single light: exit code $?"
"$replay" "$work/light.rec" >"$work/table" || fail "page of a single light: exit code $?"

"$replay" "$work/a.CDG.rec" >"$work/table" || fail "page: exit code $?"
grep -qF "open it in a browser" "$work/table" || fail "the next step is missing in: $(cat "$work/table")"
grep -qE '(src|href)="[^d]|https?://|@[A-Z]+@' "$work/a.CDG.html" && fail "the page needs another file or the network"
"$replay" "$work/a.CDG.rec" --output "$work/again.html" >"$work/table"
cmp "$work/a.CDG.html" "$work/again.html" || fail "two pages of one recording differ"

refused "'5 ms' is not a whole number of steps" "$run" "${grid[@]}" --record "$work/c.rec" --record-interval "5 ms"
refused "--record-from: value '3'" "$run" "${grid[@]}" --record "$work/c.rec" --record-from 3
refused "is after the end of the run; give at most the duration" "$run" "${grid[@]}" --record "$work/c.rec" --record-from "1 h"
refused "is not after --record-from" "$run" "${grid[@]}" --record "$work/c.rec" --record-from "9 s" --record-until "8 s"
refused "cannot create the folder" "$run" "${grid[@]}" --record "$work/a.CDG.rec/x.rec"
refused "none.rec: the file cannot be read: No such file" "$replay" "$work/none.rec"
refused "not written by stopline-run --record" "$replay" "$STOPLINE_SOURCE/README.md"
refused "Is a directory" "$replay" "$work"
head -c 3000 "$work/a.CDG.rec" >"$work/short.rec"
refused "short.rec: the file is not a readable recording: the file ends too early" "$replay" "$work/short.rec"
head -c 20000 "$work/a.CDG.rec" >"$work/longer.rec"
refused "longer.rec: the recording is damaged after" "$replay" "$work/longer.rec"
refused "no frame from 9000 s on; it covers 0 to " "$replay" "$work/a.CDG.rec" --from "9000 s"
refused "no frame from 9000 s to 9001 s; it covers 0 to " "$replay" "$work/a.CDG.rec" --from "9000 s" --until "9001 s"
refused "value '9000' has no unit: write e.g. '9000 s'" "$replay" "$work/a.CDG.rec" --from 9000
[ -e "$work/short.html" ] && fail "there is a page of an incomplete recording"
[ -e /dev/full ] && refused "No space left on device" "$replay" "$work/a.CDG.rec" --output /dev/full

# A file size limit stands in for a disk that becomes full during the run.
mkdir "$work/small"
(
    ulimit -f 16
    code=0
    "$run" "${grid[@]}" --record "$work/small/x.rec" >"$work/stdout" 2>"$work/stderr" || code=$?
    [ $code -eq 2 ] && grep -qF "File too large" "$work/stderr"
) || fail "full disk: $(cat "$work/stderr")"
[ -z "$(ls -A "$work/small")" ] || fail "an incomplete recording is left: $(ls -A "$work/small")"

code=0
timeout --preserve-status --signal=INT 2 "$run" "${grid[@]}" --set "duration=1000000 s" --record "$work/small/x.rec" \
    >"$work/stdout" 2>"$work/stderr" || code=$?
[ $code -eq 130 ] || fail "interrupted: exit code $code"
[ -z "$(ls -A "$work/small")" ] || fail "interrupted: files are left: $(ls -A "$work/small")"

exit $((failures > 0))
