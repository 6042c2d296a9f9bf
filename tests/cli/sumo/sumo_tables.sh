#!/usr/bin/env bash
# ctest-labels: slow
# Tests the output of stopline-run for SUMO's tools. Parts of it need SUMO and are skipped if it is not installed.
set -u

python3 "$STOPLINE_SOURCE/tests/sumo/tables.py" "$STOPLINE_BIN/stopline-run"
