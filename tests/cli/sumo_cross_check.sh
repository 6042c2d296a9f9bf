#!/usr/bin/env bash
# ctest-labels: slow
# The mesoscale mode with the paper's parameters beside SUMO with the same; skipped where SUMO is not installed.
set -u

python3 "$STOPLINE_SOURCE/tests/sumo/cross_check.py" "$STOPLINE_BIN/stopline-calibrate"
