#!/usr/bin/env python3
"""Exports scenarios to SUMO, reads the exported networks again, and compares all three.

    round_trip.py FOLDER_OF_STOPLINE_PROGRAMS

For the intersection, an arterial and a grid: lanes, connections, conflicts and lengths of the network that netconvert made beside ours, SUMO's
run of the export, and our run of the imported network beside the original (vehicles that arrived, their mean time). Exit codes: 0 all
within the limits below, 1 not, 77 SUMO is not installed.
"""

import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from cross_check import HERE, find_sumo

LENGTH_M = 0.1
ARRIVED = 0.02
DURATION = 0.05
SCENARIOS = HERE.parent.parent / "scenarios"
CASES = {
    "intersection": ["duration=700 s"],
    "arterial": ["duration=700 s", "measure.steady=400 s"],
    "grid": ["duration=700 s", "measure.steady=400 s", "network.grid.columns=3", "network.grid.rows=2"],
}
# Of ours, what SUMO has no word for, is left out.
AS_SUMO = ["fidelity=meso", "meso=table2", "driver.free_drive.hesitation=0 s", "driver.stop.decision_deceleration=4.7 m/s2"]
IMPORTED = """
fidelity: meso
duration: 700 s
meso: table2
vehicle: petrol_eu4_72kw
driver: {{base: startup_kit, stop: {{decision_deceleration: 4.7 m/s2}}, free_drive: {{hesitation: 0 s}}}}
network: {{kind: sumo, net: {net}, routes: [{routes}]}}
populations: [CTG-Ref]
measure: {{steady: 400 s}}
"""


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


def compare_runs(name, run, sumo, folder, changes):
    subprocess.run([run, SCENARIOS / f"{name}.yaml", *settings(changes + AS_SUMO), "--set",
                    "populations=[CTG-Ref]", "--set", "measure.baseline=CTG-Ref", "--no-figures", "--output", folder / "ours", "--tripinfo",
                    folder / "ours.xml"], check=True, stdout=subprocess.DEVNULL)
    subprocess.run([sumo, "-c", folder / "run.sumocfg", "--no-step-log", "--tripinfo-output", folder / "sumo.xml"],
                   check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    (folder / "again.yaml").write_text(IMPORTED.format(net=folder / "net.net.xml", routes=folder / "vehicles.rou.xml"))
    subprocess.run([run, folder / "again.yaml", "--no-figures", "--output", folder / "again", "--tripinfo", folder / "again.xml"],
                   check=True, stdout=subprocess.DEVNULL)
    ours, again = trips(folder / "ours.xml"), trips(folder / "again.xml")
    for text, (count, mean) in (("the original", ours), ("SUMO", trips(folder / "sumo.xml")), ("imported", again)):
        print(f"  {text}: {count} arrived, {mean:.1f} s")
    problems = []
    if abs(again[0] / ours[0] - 1) > ARRIVED:
        problems.append("other numbers arrive on the imported network")
    if abs(again[1] / ours[1] - 1) > DURATION:
        problems.append("trips take another time on the imported network")
    return problems


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    found = find_sumo()
    if found is None:
        print("SUMO is not installed (pip install eclipse-sumo): skipped")
        return 77
    programs = Path(sys.argv[1]).resolve()
    failed = False
    with tempfile.TemporaryDirectory() as top:
        for name, changes in CASES.items():
            folder = Path(top) / name
            print(name)
            subprocess.run([programs / "stopline-export", "--sumo", folder, SCENARIOS / f"{name}.yaml", "--population", "CTG-Ref",
                            *settings(changes + AS_SUMO)], check=True, stdout=subprocess.DEVNULL)
            subprocess.run([found[1], "-n", "nodes.nod.xml", "-e", "edges.edg.xml", "-x", "connections.con.xml", "-i",
                            "lights.tll.xml", "--no-turnarounds", "true", "--offset.disable-normalization", "true", "-o",
                            "net.net.xml"], cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            problems = compare_network(folder) + compare_runs(name, programs / "stopline-run", found[0], folder, changes)
            for problem in problems:
                print(f"  NOT AS IT SHOULD BE: {problem}")
            failed |= bool(problems)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
