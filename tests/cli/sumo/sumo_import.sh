#!/usr/bin/env bash
# ctest-labels: slow
# ctest-timeout: 900
# Tests that imported networks of SUMO's netgenerate (grids, spiders, random networks) run without violations with
# random trips. Skipped if SUMO is not installed.
set -u

for fidelity in meso full; do
    python3 "$STOPLINE_SOURCE/tests/sumo/import_nets.py" "$STOPLINE_BIN" --fidelity "$fidelity" || exit
done
