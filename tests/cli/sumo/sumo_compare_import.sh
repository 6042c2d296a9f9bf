#!/usr/bin/env bash
# ctest-labels: slow
# Tests stopline-compare on an imported network of SUMO's netgenerate. Skipped if SUMO is not installed.
set -u

python3 "$STOPLINE_SOURCE/tests/sumo/compare_import.py" "$STOPLINE_BIN"
