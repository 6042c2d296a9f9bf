#!/usr/bin/env bash
# ctest-labels: slow
# ctest-timeout: 900
# Tests that exported networks, imported again, give the same traffic as the originals. Skipped if SUMO is not
# installed.
set -u

python3 "$STOPLINE_SOURCE/tests/sumo/round_trip.py" "$STOPLINE_BIN"
