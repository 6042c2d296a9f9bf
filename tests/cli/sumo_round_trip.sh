#!/usr/bin/env bash
# ctest-labels: slow
# ctest-timeout: 900
# Exported networks run here again like the originals; skipped where SUMO is not installed.
set -u

python3 "$STOPLINE_SOURCE/tests/sumo/round_trip.py" "$STOPLINE_BIN"
