#!/usr/bin/env bash
# Tests that old names of fields still work. Each gives one warning on standard error, with its place and the new name.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"

# warns PLACE COMMAND...: expects exit code 0 and one line on standard error, a warning that begins with PLACE
warns() {
    local place=$1
    shift
    "$@" >"$work/stdout" 2>"$work/stderr" || fail "$*: exit code $?: $(cat "$work/stderr")"
    [ "$(wc -l <"$work/stderr")" -eq 1 ] || fail "$*: standard error has not one line: $(cat "$work/stderr")"
    local expected="warning: $place: field 'measure.steady' is now called 'measure.window'; the old name will be removed"
    grep -qF -- "$expected" "$work/stderr" || fail "$*: '$expected' is missing in: $(cat "$work/stderr")"
}

printf 'title: old\nmeasure: {steady: 300 s}\nnetwork: {kind: grid}\n' >"$work/old.yaml"
printf 'title: new\nnetwork: {kind: grid}\n' >"$work/new.yaml"
printf 'scenario: new.yaml\naxes:\n- {name: window, path: measure.steady, values: [300 s, 400 s]}\n' >"$work/axis.yaml"
printf 'scenario: old.yaml\naxes:\n- {name: green, path: signal.green, values: [20 s, 30 s]}\n' >"$work/sweep.yaml"
setting="measure.steady=200 s"

warns "$work/old.yaml:2:11" "$STOPLINE_BIN/stopline-run" --list "$work/old.yaml"
warns "--set '$setting'" "$STOPLINE_BIN/stopline-run" --list "$work/new.yaml" --set "$setting"
warns "$work/axis.yaml:3:24" "$STOPLINE_BIN/stopline-sweep" --list "$work/axis.yaml"
warns "$work/old.yaml:2:11" "$STOPLINE_BIN/stopline-sweep" --list "$work/sweep.yaml"

exit $((failures > 0))
