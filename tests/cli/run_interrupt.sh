#!/usr/bin/env bash
# Ctrl-C ends any long work with exit code 130 and leaves no file; progress is a bar on a terminal and silent for short work.
set -u

failures=0
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
run="$STOPLINE_BIN/stopline-run"
scenario="$STOPLINE_SOURCE/scenarios/single_light.yaml"
endless=(--set "duration=1000000 s" --no-figures --threads 2)

fail() {
    echo "FAILED: $*"
    failures=$((failures + 1))
}

code=0
timeout --signal=INT 2 "$run" "$scenario" "${endless[@]}" --output "$work/out" >"$work/stdout" 2>"$work/stderr" || code=$?
# timeout itself ends with 124; --preserve-status would give the program's code, which is what counts here.
[ $code -eq 124 ] || fail "did not run until the signal: exit code $code"
code=0
timeout --preserve-status --signal=INT 2 "$run" "$scenario" "${endless[@]}" --output "$work/out" \
    >"$work/stdout" 2>"$work/stderr" || code=$?
[ $code -eq 130 ] || fail "exit code $code instead of 130"
grep -q "interrupted" "$work/stderr" || fail "no word of the interrupt: $(cat "$work/stderr")"
[ -s "$work/stdout" ] && fail "results of runs that did not end: $(head -n 3 "$work/stdout")"
[ -z "$(find "$work/out" -type f)" ] || fail "files are left: $(ls -A "$work/out")"

# interrupted SECONDS PROGRAM [OPTION...]: exit code 130, no file and nothing on standard output
interrupted() {
    local seconds=$1 program=$2
    shift 2
    local code=0
    rm -rf "$work/stopped"
    timeout --preserve-status --signal=INT "$seconds" "$STOPLINE_BIN/$program" "$@" --output "$work/stopped" \
        >"$work/stdout" 2>"$work/stderr" || code=$?
    [ $code -eq 130 ] || fail "$program $*: exit code $code instead of 130: $(cat "$work/stderr")"
    [ -s "$work/stdout" ] && fail "$program $*: results: $(head -n 3 "$work/stdout")"
    [ -z "$(find "$work" -path "$work/stopped/*" -type f)" ] || fail "$program $*: files are left: $(ls -R "$work/stopped")"
}
interrupted 1 stopline-scorecard --section IV
interrupted 1 stopline-startup --fit

"$run" "$STOPLINE_SOURCE/scenarios/first_steps.yaml" --no-figures --output "$work/short" >/dev/null 2>"$work/stderr"
[ -s "$work/stderr" ] && fail "short work shows progress: $(cat "$work/stderr")"

# script runs the program on a terminal of its own.
if command -v script >/dev/null; then
    printf -v command '%q ' timeout --signal=INT 4 "$run" "$scenario" "${endless[@]}" --output "$work/out"
    script --quiet --command "$command" "$work/typescript" </dev/null >/dev/null
    grep -qE '8 runs \[[#.]{30}\] +[0-9]+ %, .* left' "$work/typescript" || fail "no bar on a terminal"
    [ "$(grep -c left "$work/typescript")" -le 1 ] || fail "the bar takes more than one line"
fi

exit $((failures > 0))
