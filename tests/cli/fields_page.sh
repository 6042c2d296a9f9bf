#!/usr/bin/env bash
# scenarios/FIELDS.md is what stopline-run --describe-markdown prints.
set -u

. "$STOPLINE_SOURCE/tests/tools/cli.sh"

"$STOPLINE_BIN/stopline-run" --describe-markdown >"$work/FIELDS.md" || fail "exit code $?"
diff "$work/FIELDS.md" "$STOPLINE_SOURCE/scenarios/FIELDS.md" >"$work/difference" ||
    fail "write the page again with 'stopline-run --describe-markdown > scenarios/FIELDS.md': $(head -n 20 "$work/difference")"

exit $((failures > 0))
