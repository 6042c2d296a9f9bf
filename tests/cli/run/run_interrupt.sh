#!/usr/bin/env bash
# Tests that Ctrl-C ends long work with exit code 130 and leaves no file. On a terminal, long work shows a progress bar
# and short work shows none.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"
run="$STOPLINE_BIN/stopline-run"
scenario="$STOPLINE_SOURCE/scenarios/single_light.yaml"
endless=(--set "duration=1000000 s" --no-figures --threads 2)

code=0
timeout --signal=INT 2 "$run" "$scenario" "${endless[@]}" --output "$work/out" >"$work/stdout" 2>"$work/stderr" || code=$?
# Without --preserve-status, timeout returns 124 if it has sent the signal. With --preserve-status, as in the next call,
# timeout returns the exit code of the program.
[ $code -eq 124 ] || fail "the run ended before the signal: exit code $code"
code=0
timeout --preserve-status --signal=INT 2 "$run" "$scenario" "${endless[@]}" --output "$work/out" \
    >"$work/stdout" 2>"$work/stderr" || code=$?
[ $code -eq 130 ] || fail "exit code $code instead of 130"
grep -q "interrupted" "$work/stderr" || fail "the interrupt is not reported: $(cat "$work/stderr")"
[ -s "$work/stdout" ] && fail "results of unfinished runs are printed: $(head -n 3 "$work/stdout")"
[ -z "$(find "$work/out" -type f)" ] || fail "files are left: $(ls -A "$work/out")"

# interrupted SECONDS PROGRAM [OPTION...]: interrupts a program; expects exit code 130, no file, and nothing on standard
# output
interrupted() {
    local seconds=$1 program=$2
    shift 2
    local code=0
    rm -rf "$work/stopped"
    timeout --preserve-status --signal=INT "$seconds" "$STOPLINE_BIN/$program" "$@" --output "$work/stopped" \
        >"$work/stdout" 2>"$work/stderr" || code=$?
    [ $code -eq 130 ] || fail "$program $*: exit code $code instead of 130: $(cat "$work/stderr")"
    [ -s "$work/stdout" ] && fail "$program $*: standard output is not empty: $(head -n 3 "$work/stdout")"
    [ -z "$(find "$work" -path "$work/stopped/*" -type f)" ] || fail "$program $*: files are left: $(ls -R "$work/stopped")"
}
interrupted 1 stopline-scorecard --section IV
interrupted 1 stopline-startup --fit
interrupted 1 stopline-strings --sweep --population CTG-Ref

"$run" "$STOPLINE_SOURCE/scenarios/first_steps.yaml" --no-figures --output "$work/short" >/dev/null 2>"$work/stderr"
[ -s "$work/stderr" ] && fail "short work shows progress: $(cat "$work/stderr")"

if command -v script >/dev/null; then
    on_terminal '8 runs \[[#.]{30}\] +[0-9]+ %, .* left' "$run" "$scenario" "${endless[@]}" --output "$work/out"
    [ "$(grep -c left "$work/typescript")" -le 1 ] || fail "the bar takes more than one line"
fi

exit $((failures > 0))
