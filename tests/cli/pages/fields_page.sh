#!/usr/bin/env bash
# Tests that scenarios/FIELDS.md is the output of stopline-run --describe-markdown.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"

"$STOPLINE_BIN/stopline-run" --describe-markdown >"$work/FIELDS.md" || fail "exit code $?"
diff "$work/FIELDS.md" "$STOPLINE_SOURCE/scenarios/FIELDS.md" >"$work/difference" ||
    fail "scenarios/FIELDS.md is out of date; write it with 'stopline-run --describe-markdown > scenarios/FIELDS.md': $(head -n 20 "$work/difference")"

exit $((failures > 0))
