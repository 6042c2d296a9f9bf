#!/usr/bin/env bash
# ctest-labels: slow
# stopline-compare on an imported network of SUMO's netgenerate; skipped where SUMO is not installed.
set -u

python3 "$STOPLINE_SOURCE/tests/sumo/compare_import.py" "$STOPLINE_BIN"
