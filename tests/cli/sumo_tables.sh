#!/usr/bin/env bash
# ctest-labels: slow
# What stopline-run writes for SUMO's tools; where SUMO is not installed its part is skipped.
set -u

python3 "$STOPLINE_SOURCE/tests/sumo/tables.py" "$STOPLINE_BIN/stopline-run"
