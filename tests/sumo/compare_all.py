#!/usr/bin/env python3
"""The mesoscale mode beside SUMO over greens and turns, with what SUMO has no word for left out of ours.

    compare_all.py FOLDER_OF_STOPLINE_PROGRAMS [SEEDS]        three seeds, if not given

Prints a row for each combination: intersection (24), arterial, grid (3 x 2), single light; CTG-Ref with the paper's parameters.
Left out are the half second that the first of a queue hesitates, and how our drivers brake: they do as SUMO's vehicles do.
Exit codes: 0 throughput within 5 % and travel time within 8 % everywhere, 1 not, 77 SUMO is not installed.
"""

import csv
import itertools
import os
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from cross_check import HERE, find_sumo

SCENARIOS = HERE.parent.parent / "scenarios"
# SUMO's vehicles brake for lines and for gaps in oncoming traffic as hard as they can: 4.7 m/s2 with the paper's parameters. On
# yellow they stop if v^2 / (2 * 4.7 m/s2) - v * 0.05 s (their steps) is no more than the distance to the line, ours if it is
# no more than that to where they would stand, 1 m before: at 30 to 50 km/h the same as 5.8 to 5.1 m/s2. Taken after 4.7 had been
# tried; a check by another way (4.9, driver.stop.margin=0 m) does not confirm it at 10 s of green (+10.8 % throughput).
AS_SUMO = ["driver.free_drive.hesitation=0 s", "driver.stop.decision_deceleration=5.3 m/s2",
           "driver.stop.deceleration=4.7 m/s2", "meso=table2"]
THROUGHPUT, TRAVEL_TIME = 5.0, 8.0  # percent
GREENS_S = [5, 10, 15, 20, 25, 30, 35, 40]
TURNS = [(0, 0), (5, 10), (15, 15)]  # left, right, in percent


def cases():
    yield "single_light", ["duration=600 s"]
    for green, (left, right) in itertools.product(GREENS_S, TURNS):
        yield "intersection", [f"signal.green={green} s", f"demand.left={left} %", f"demand.right={right} %",
                               "duration=900 s"]
    for green, left in itertools.product((15, 25), (0, 5)):
        yield "grid", [f"signal.green={green} s", f"demand.left={left} %", f"demand.right={2 * left} %", "duration=900 s",
                       "measure.window=600 s", "network.grid.columns=3", "network.grid.rows=2"]
    for offset in (0, 15):
        yield "arterial", [f"signal.offset={offset} s", "duration=900 s", "measure.window=600 s"]


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    seeds = int(sys.argv[2]) if len(sys.argv) == 3 else 3
    found = find_sumo()
    if found is None:
        print("SUMO is not installed (pip install eclipse-sumo): skipped")
        return 77
    environment = {**os.environ, "PATH": f"{Path(found[0]).parent}:{os.environ['PATH']}"}
    program = Path(sys.argv[1]).resolve() / "stopline-compare"
    beyond = 0
    with tempfile.TemporaryDirectory() as folder:
        for name, changes in cases():
            words = [word for change in changes + AS_SUMO for word in ("--set", change)]
            subprocess.run([program, SCENARIOS / f"{name}.yaml", "--population", "CTG-Ref", "--repetitions", str(seeds), "--no-figures",
                            "--output", folder, *words], check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                           env=environment)
            with open(Path(folder) / "comparison.csv", encoding="utf-8") as file:
                rows = list(csv.DictReader(file))
            means, percent = {}, {}
            for metric in ("throughput_veh_h", "travel_time_s"):
                means[metric] = [statistics.mean(float(row[k] or "nan") for row in rows if row["metric"] == metric)
                                 for k in ("ours", "sumo")]
                ours, sumo = means[metric]
                percent[metric] = 100 * (ours / sumo - 1) if sumo else float("nan")
            out = abs(percent["throughput_veh_h"]) > THROUGHPUT or abs(percent["travel_time_s"]) > TRAVEL_TIME
            beyond += out
            values = "  ".join(f"{m} {means[m][0]:.1f} {means[m][1]:.1f} {percent[m]:+.1f} %" for m in percent)
            print(f"{name} {' '.join(changes[:3])}: {values}{'  BEYOND' if out else ''}", flush=True)
    print(f"{beyond} beyond the limits")
    return 1 if beyond else 0


if __name__ == "__main__":
    sys.exit(main())
