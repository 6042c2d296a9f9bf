#!/usr/bin/env python3
"""Exports scenarios to SUMO, reads the exported networks again, and compares all three.

    round_trip.py FOLDER_OF_STOPLINE_PROGRAMS [--seeds N]        three seeds, if not given

For the intersection, an arterial and a grid: lanes, connections and lengths of the network that netconvert made beside ours, SUMO's
run of the export, and our run of the imported network beside the original (vehicles that arrived, their mean time). Conflicts and who
gives way are compared by round_trip_test.cpp. Of the runs the differences between imported and original, seed by seed, have a mean
with its 95 % interval (Student): equal is where that contains 0, or where the mean is within the limits below. Exit codes: 0 all is
equal, 1 not, 77 SUMO is not installed.
"""

import argparse
import math
import statistics
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from cross_check import HERE, find_sumo

LENGTH_M = 0.1
ARRIVED, DURATION = 2.0, 5.0  # percent
# Student's t by degrees of freedom from 1 on, 97.5 %.
STUDENT = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131, 2.120, 2.110,
           2.101, 2.093]
SCENARIOS = HERE.parent.parent / "scenarios"
CASES = {
    "intersection": ["duration=700 s"],
    "arterial": ["duration=700 s", "measure.window=400 s"],
    "grid": ["duration=700 s", "measure.window=400 s", "network.grid.columns=3", "network.grid.rows=2"],
}
# Of ours, what SUMO has no word for, is left out.
AS_SUMO = ["fidelity=meso", "meso=table2", "driver.free_drive.hesitation=0 s", "driver.stop.decision_deceleration=4.7 m/s2"]
# The rules of the original are its scenario's. Nobody changes lanes there, which nobody gains enough for here: of imported networks
# the lanes of an edge are beside each other, and changes for speed even out the queues.
IMPORTED = """
fidelity: meso
duration: 700 s
seed: {seed}
meso: table2
vehicle: petrol_eu4_72kw
driver:
  base: startup_kit
  stop: {{decision_deceleration: 4.7 m/s2}}
  free_drive: {{hesitation: 0 s}}
  lane_change: {{threshold: 10 m/s2}}
network: {{kind: sumo, net: {net}, routes: [{routes}]}}
rules: {rules}
populations: [CTG-Ref]
measure: {{window: 400 s}}
"""
RULES = {"intersection": "{}", "arterial": "{keep_clear: on, teleport_cycles: 3, pass_blocker_greens: 2}"}
RULES["grid"] = RULES["arterial"]


def settings(changes):
    return [word for change in changes for word in ("--set", change)]


def plain(folder):
    """Lanes by edge, length by edge, and connections, as we wrote them."""
    edges = {e.get("id"): e for e in ElementTree.parse(folder / "edges.edg.xml").getroot().iter("edge")}
    connections = list(ElementTree.parse(folder / "connections.con.xml").getroot().iter("connection"))
    return ({k: int(e.get("numLanes")) for k, e in edges.items()}, {k: float(e.get("length")) for k, e in edges.items()},
            {(c.get("from"), c.get("to"), c.get("fromLane"), c.get("toLane")): c for c in connections})


def inner_length(lanes, connections, connection):
    """Of the lanes inside the junction that a connection goes over."""
    length = 0.0
    via = connection.get("via")
    while via:
        length += float(lanes[via].get("length"))
        edge, index = via.rsplit("_", 1)
        after = [c for c in connections if c.get("from") == edge and c.get("fromLane") == index]
        via = after[0].get("via") if after else None
    return length


def compare_network(folder):
    """Differences between what was written and what netconvert made of it."""
    lanes_of, length_of, wanted = plain(folder)
    root = ElementTree.parse(folder / "net.net.xml").getroot()
    lanes = {lane.get("id"): lane for lane in root.iter("lane")}
    connections = list(root.iter("connection"))
    problems = []
    outside = [e for e in root.iter("edge") if e.get("function") is None]
    if {e.get("id"): len(e.findall("lane")) for e in outside} != lanes_of:
        problems.append("edges or their lanes differ")
    worst = 0.0
    for edge in outside:
        for lane in edge.findall("lane"):
            worst = max(worst, abs(float(lane.get("length")) - length_of[edge.get("id")]))
    made = {(c.get("from"), c.get("to"), c.get("fromLane"), c.get("toLane")): c for c in connections
            if not c.get("from").startswith(":")}
    if set(made) != set(wanted):
        problems.append(f"connections differ: {sorted(set(made) ^ set(wanted))[:3]}")
    for key in set(made) & set(wanted):
        if wanted[key].get("length"):
            worst = max(worst, abs(inner_length(lanes, connections, made[key]) - float(wanted[key].get("length"))))
    if worst > LENGTH_M:
        problems.append(f"lengths differ by {worst:.2f} m")
    print(f"  {len(lanes_of)} edges, {sum(lanes_of.values())} lanes, {len(made)} connections; largest difference of a length "
          f"{worst:.3f} m")
    return problems


def trips(file):
    times = [float(t.get("duration")) for t in ElementTree.parse(file).getroot().iter("tripinfo")]
    return len(times), sum(times) / max(len(times), 1)


def run_all(name, seed, programs, found, folder):
    """Of the original, of SUMO and of the imported network: how many arrived, and their mean time."""
    seeded = settings(CASES[name] + AS_SUMO) + ["--seed", str(seed)]
    quiet = {"check": True, "stdout": subprocess.DEVNULL}
    subprocess.run([programs / "stopline-export", "--sumo", folder, SCENARIOS / f"{name}.yaml", "--population", "CTG-Ref", *seeded],
                   **quiet)
    subprocess.run([found[1], "-n", "nodes.nod.xml", "-e", "edges.edg.xml", "-x", "connections.con.xml", "-i", "lights.tll.xml",
                    "--no-turnarounds", "true", "--offset.disable-normalization", "true", "-o", "net.net.xml"], cwd=folder,
                   stderr=subprocess.DEVNULL, **quiet)
    subprocess.run([programs / "stopline-run", SCENARIOS / f"{name}.yaml", *seeded, "--set", "populations=[CTG-Ref]", "--set",
                    "measure.baseline=CTG-Ref", "--no-figures", "--output", folder / "ours", "--tripinfo", folder / "ours.xml"],
                   **quiet)
    subprocess.run([found[0], "-c", folder / "run.sumocfg", "--seed", str(seed), "--no-step-log", "--tripinfo-output",
                    folder / "sumo.xml"], stderr=subprocess.DEVNULL, **quiet)
    (folder / "again.yaml").write_text(IMPORTED.format(net=folder / "net.net.xml", routes=folder / "vehicles.rou.xml",
                                                       seed=seed, rules=RULES[name]))
    subprocess.run([programs / "stopline-run", folder / "again.yaml", "--no-figures", "--output", folder / "again", "--tripinfo",
                    folder / "again.xml"], stderr=subprocess.DEVNULL, **quiet)
    return {text: trips(folder / file)
            for text, file in (("the original", "ours.xml"), ("SUMO", "sumo.xml"), ("imported", "again.xml"))}


def difference(what, before, after, limit):
    """Of pairs: prints mean and interval. True: equal, as the top of this file says."""
    percent = [100 * (b / a - 1) for a, b in zip(before, after)]
    mean, more = statistics.mean(percent), math.inf
    if len(percent) > 1:
        more = STUDENT[min(len(percent) - 1, len(STUDENT)) - 1] * statistics.stdev(percent) / math.sqrt(len(percent))
    print(f"  imported - original, {what}: {mean:+.2f} % +- {more:.2f} %")
    # One seed has no interval.
    return abs(mean) <= limit or (math.isfinite(more) and abs(mean) <= more)


def compare_runs(runs):
    for text in runs[0]:
        print(f"  {text}: {', '.join(f'{run[text][0]} arrived, {run[text][1]:.1f} s' for run in runs)}")
    problems = []
    for column, what, limit in ((0, "arrived", ARRIVED), (1, "mean time", DURATION)):
        values = [[run[text][column] for run in runs] for text in ("the original", "imported")]
        if not difference(what, *values, limit):
            problems.append(f"{what}: another one on the imported network")
    return problems


def main():
    parser = argparse.ArgumentParser(description="SUMO's runs and ours of exported networks.")
    parser.add_argument("programs", type=Path)
    parser.add_argument("--seeds", type=int, default=3)
    options = parser.parse_args()
    found = find_sumo()
    if found is None:
        print("SUMO is not installed (pip install eclipse-sumo): skipped")
        return 77
    failed = False
    with tempfile.TemporaryDirectory() as top:
        for name in CASES:
            print(name, flush=True)
            folders = [Path(top) / f"{name}_{k + 1}" for k in range(options.seeds)]
            runs = [run_all(name, k + 1, options.programs.resolve(), found, folder) for k, folder in enumerate(folders)]
            problems = compare_network(folders[0]) + compare_runs(runs)
            for problem in problems:
                print(f"  NOT AS IT SHOULD BE: {problem}", flush=True)
            failed |= bool(problems)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
