#!/usr/bin/env bash
# ctest-labels: slow
# ctest-timeout: 900
# Networks of SUMO's netgenerate (grids, spiders, random ones) with random trips run here without violations; skipped where SUMO is not
# installed.
set -u

for fidelity in meso full; do
    python3 "$STOPLINE_SOURCE/tests/sumo/import_nets.py" "$STOPLINE_BIN" --fidelity "$fidelity" || exit
done
