#!/usr/bin/env python3
"""Tests stopline-compare on an imported network: a grid of SUMO's netgenerate with signals and random trips.

    compare_import.py FOLDER_OF_STOPLINE_PROGRAMS

Checks the exit code and the table, the vehicles and planned times in SUMO's run, the signal offsets of the additional
file, and that both simulations give similar results. Exit codes: 0 all checks pass, 1 a check fails, 77 SUMO is not
installed.
"""

import csv
import os
import re
import statistics
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from import_nets import make, sumo_home

NET = "--grid --grid.number 3 --grid.length 150 --grid.attach-length 150 -L 2 --default-junction-type traffic_light"
SCENARIO = """
fidelity: meso
duration: 600 s
meso: table2
network: {kind: sumo, net: ./grid.net.xml.gz, routes: [./grid.trips.xml], additional: [./offset.add.xml]}
populations: [CDG, CTG-Ref]
measure: {baseline: CTG-Ref, window: 400 s}
"""
OFFSET = '<additional><tlLogic id="B1" programID="0" offset="13"/></additional>'
MAX_DIFFERENCE = {"throughput_veh_h": 5.0, "travel_time_s": 12.0, "stop_line_passages_veh_h": 5.0}  # percent


def problems_of_table(text):
    """Yields problems of the printed table."""
    rows = [line for line in text.splitlines() if re.match(r"  ([a-z_]+_(veh_h|s|mps|vehicles)|backlog|teleported) ", line)]
    if len(rows) < 7:
        yield f"the table has {len(rows)} rows instead of at least 7:\n{text}"
    for row in rows:
        columns = row.split()
        if not all(re.fullmatch(r"-?[0-9]+\.[0-9]+", column) for column in columns[1:3]):
            yield f"a row has not two numbers: {row}"


def problems_of_files(folder, out):
    """Yields differences between the files of the scenario and SUMO's input and output."""
    trips = {t.get("id"): float(t.get("depart")) for t in ElementTree.parse(folder / "grid.trips.xml").getroot().iter("trip")}
    vehicles = ElementTree.parse(out / "vehicles.rou.xml").getroot().iter("vehicle")
    departures = {v.get("id"): float(v.get("depart")) for v in vehicles}
    if departures != {name: depart for name, depart in trips.items() if depart < 600}:
        yield "the vehicles differ from the trips, or depart at other times"
    completed = {t.get("id"): float(t.get("depart")) - float(t.get("departDelay"))
             for t in ElementTree.parse(out / "trips.out.xml").getroot().iter("tripinfo")}
    if len(completed) < 100 or any(abs(planned - trips[name]) > 0.15 for name, planned in completed.items()):
        yield f"SUMO completed {len(completed)} trips, or planned them at other times"
    offsets = {t.get("id"): float(t.get("offset")) for t in ElementTree.parse(out / "lights.add.xml").getroot().iter("tlLogic")}
    if {name: offset for name, offset in offsets.items() if offset != 0.0} != {"B1": 13.0}:
        yield f"the signal offsets are wrong: {offsets}"


def problems_of_means(out):
    """Yields metrics whose means differ too much between the simulations."""
    with open(out / "comparison.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for metric, percent in MAX_DIFFERENCE.items():
        ours, sumo = (statistics.mean(float(row[k]) for row in rows if row["metric"] == metric) for k in ("ours", "sumo"))
        if abs(100 * (ours / sumo - 1)) > percent:
            yield f"{metric}: ours {ours:.1f}, SUMO {sumo:.1f}, more than {percent} % apart"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    home = sumo_home()
    if home is None:
        print("skipped: SUMO is not installed (pip install eclipse-sumo)")
        return 77
    programs = Path(sys.argv[1]).resolve()
    environment = {**os.environ, "PATH": f"{home / 'bin'}:{os.environ['PATH']}"}
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        make(home, folder, "grid", NET, 1)
        (folder / "grid.yaml").write_text(SCENARIO)
        (folder / "offset.add.xml").write_text(OFFSET)
        result = subprocess.run([programs / "stopline-compare", "grid.yaml", "--repetitions", "2", "--no-figures", "--output", "out"],
                             cwd=folder, env=environment, capture_output=True, text=True, check=False)
        if result.returncode != 0:
            problems = [f"exit code {result.returncode}: {result.stderr}"]
        else:
            problems = [*problems_of_table(result.stdout), *problems_of_files(folder, folder / "out" / "seed_1"),
                        *problems_of_means(folder / "out")]
        refused = subprocess.run([programs / "stopline-export", "--sumo", "export", "grid.yaml"], cwd=folder, env=environment,
                                 capture_output=True, text=True, check=False)
        if refused.returncode != 2 or (folder / "export").exists():
            problems.append("stopline-export does not refuse the imported network")
    for problem in problems:
        print(f"FAILED: {problem}")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
