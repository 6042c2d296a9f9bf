#!/usr/bin/env bash
# ctest-labels: slow
# The mesoscale mode with the paper's parameters beside SUMO with the same; skipped where SUMO is not installed.
set -u

python3 "$STOPLINE_SOURCE/tests/sumo/cross_check.py" "$STOPLINE_BIN/stopline-calibrate"
code=$?
[ $code -eq 0 ] || exit $code
python3 "$STOPLINE_SOURCE/tests/sumo/intersection.py" "$STOPLINE_BIN"
