#!/usr/bin/env bash
# ctest-labels: slow
# Compares the mesoscale mode with SUMO, both with the paper's parameters. Skipped if SUMO is not installed.
set -u

python3 "$STOPLINE_SOURCE/tests/sumo/cross_check.py" "$STOPLINE_BIN/stopline-calibrate"
code=$?
[ $code -eq 0 ] || exit $code
python3 "$STOPLINE_SOURCE/tests/sumo/intersection.py" "$STOPLINE_BIN"
