#!/usr/bin/env python3
"""Exports scenarios to SUMO, imports the exported networks, and compares the traffic.

    round_trip.py FOLDER_OF_STOPLINE_PROGRAMS [--seeds N]        default: three seeds

The scenarios are an intersection, an arterial and a grid. The script compares lanes, connections and lengths of
netconvert's network with the export. It runs the original, the export in SUMO, and the imported network, and compares
the number of arrivals and the mean travel time. The original and the imported network count as equal if the 95 %
confidence interval of their differences over the seeds contains 0, or if the mean difference is at most 2 %
(arrivals) or 5 % (travel time). round_trip_test.cpp compares conflicts and right of way. Exit codes: 0 all are equal, 1
there is a difference, 77 SUMO is not installed.
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
# 97.5 % quantiles of Student's t distribution, for 1, 2, 3 ... degrees of freedom.
STUDENT = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179, 2.160, 2.145, 2.131, 2.120, 2.110,
           2.101, 2.093]
SCENARIOS = HERE.parent.parent / "scenarios"
CASES = {
    "intersection": ["duration=700 s"],
    "arterial": ["duration=700 s", "measure.window=400 s"],
    "grid": ["duration=700 s", "measure.window=400 s", "network.grid.columns=3", "network.grid.rows=2"],
}
# Settings of our model that match SUMO's.
AS_SUMO = ["fidelity=meso", "meso=table2", "driver.free_drive.hesitation=0 s", "driver.stop.decision_deceleration=4.7 m/s2"]
# The imported network gets the traffic rules of the original scenario. The original has no lane changes. In an imported
# network the lanes of an edge are neighbours, so a high threshold prevents lane changes for speed, which would even out
# the queues.
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
    return [option for change in changes for option in ("--set", change)]


def plain(folder):
    """Returns the number of lanes by edge, the length by edge, and the connections of the exported files."""
    edges = {e.get("id"): e for e in ElementTree.parse(folder / "edges.edg.xml").getroot().iter("edge")}
    connections = list(ElementTree.parse(folder / "connections.con.xml").getroot().iter("connection"))
    return ({k: int(e.get("numLanes")) for k, e in edges.items()}, {k: float(e.get("length")) for k, e in edges.items()},
            {(c.get("from"), c.get("to"), c.get("fromLane"), c.get("toLane")): c for c in connections})


def inner_length(lanes, connections, connection):
    """Returns the total length of the lanes inside the junction that a connection uses, m."""
    length = 0.0
    via = connection.get("via")
    while via:
        length += float(lanes[via].get("length"))
        edge, index = via.rsplit("_", 1)
        after = [c for c in connections if c.get("from") == edge and c.get("fromLane") == index]
        via = after[0].get("via") if after else None
    return length


def compare_network(folder):
    """Returns differences between the exported network and netconvert's network."""
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
    built = {(c.get("from"), c.get("to"), c.get("fromLane"), c.get("toLane")): c for c in connections
            if not c.get("from").startswith(":")}
    if set(built) != set(wanted):
        problems.append(f"connections differ: {sorted(set(built) ^ set(wanted))[:3]}")
    for key in set(built) & set(wanted):
        if wanted[key].get("length"):
            worst = max(worst, abs(inner_length(lanes, connections, built[key]) - float(wanted[key].get("length"))))
    if worst > LENGTH_M:
        problems.append(f"lengths differ by {worst:.2f} m")
    print(f"  {len(lanes_of)} edges, {sum(lanes_of.values())} lanes, {len(built)} connections; largest difference in length "
          f"{worst:.3f} m")
    return problems


def trips(file):
    times = [float(t.get("duration")) for t in ElementTree.parse(file).getroot().iter("tripinfo")]
    return len(times), sum(times) / max(len(times), 1)


def run_all(name, seed, programs, found, folder):
    """Returns the number of arrivals and their mean travel time for the original, for SUMO, and for the imported network."""
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


def counts_as_equal(quantity, original, imported, limit):
    """Prints the mean difference and its interval. Returns True if the values count as equal."""
    percent = [100 * (b / a - 1) for a, b in zip(original, imported)]
    mean, half_width = statistics.mean(percent), math.inf
    if len(percent) > 1:
        half_width = STUDENT[min(len(percent) - 1, len(STUDENT)) - 1] * statistics.stdev(percent) / math.sqrt(len(percent))
    print(f"  imported - original, {quantity}: {mean:+.2f} % +- {half_width:.2f} %")
    # A single seed gives no interval.
    return abs(mean) <= limit or (math.isfinite(half_width) and abs(mean) <= half_width)


def compare_runs(runs):
    for text in runs[0]:
        print(f"  {text}: {', '.join(f'{run[text][0]} arrived, {run[text][1]:.1f} s' for run in runs)}")
    problems = []
    for column, quantity, limit in ((0, "arrivals", ARRIVED), (1, "mean travel time", DURATION)):
        values = [[run[text][column] for run in runs] for text in ("the original", "imported")]
        if not counts_as_equal(quantity, *values, limit):
            problems.append(f"the imported network differs from the original: {quantity}")
    return problems


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=Path)
    parser.add_argument("--seeds", type=int, default=3)
    options = parser.parse_args()
    found = find_sumo()
    if found is None:
        print("skipped: SUMO is not installed (pip install eclipse-sumo)")
        return 77
    failed = False
    with tempfile.TemporaryDirectory() as top:
        for name in CASES:
            print(name, flush=True)
            folders = [Path(top) / f"{name}_{k + 1}" for k in range(options.seeds)]
            runs = [run_all(name, k + 1, options.programs.resolve(), found, folder) for k, folder in enumerate(folders)]
            problems = compare_network(folders[0]) + compare_runs(runs)
            for problem in problems:
                print(f"  FAILED: {problem}", flush=True)
            failed |= bool(problems)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
