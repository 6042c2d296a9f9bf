#!/usr/bin/env python3
"""Compares the mesoscale mode with SUMO at the reference intersection, with the paper's parameters and without turns.

    intersection.py FOLDER_OF_STOPLINE_PROGRAMS [--speed]

Counts the vehicles that pass the eight stop lines in each of ten cycles. --speed also compares the vehicle updates per
second of both programs on one thread each. Exit codes: 0 the mean counts per lane differ by at most one vehicle in
every cycle, 1 they differ by more, 77 SUMO is not installed.
"""

import csv
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from cross_check import CYCLES, GREENS_S, HERE, LIMIT_MPS, WARMUP_CYCLES, cycle_of, find_sumo, per_cycle

LEGS = {"north": (0, 1), "east": (1, 0), "south": (0, -1), "west": (-1, 0)}
OPPOSITE = {"north": "south", "south": "north", "east": "west", "west": "east"}
RADIUS_M = 20.0
APPROACH_M = 250.0
EXIT_M = 99.0
SPEED_GREEN_S = 15
SPEED_S = 20000

CTG = """<vType id="ctg" carFollowModel="Krauss" accel="1.7" decel="4.7" tau="0.9" minGap="2.95" sigma="0.4" length="5.15"
         maxSpeed="40" speedFactor="1" speedDev="0"/>"""


def write_network(netconvert, folder):
    nodes, edges, connections = [], [], []
    for leg, (x, y) in LEGS.items():
        far = RADIUS_M + APPROACH_M
        near = RADIUS_M + EXIT_M
        nodes.append(f'<node id="{leg}_from" x="{x * far}" y="{y * far}"/>')
        nodes.append(f'<node id="{leg}_to" x="{x * near}" y="{y * near}"/>')
        edges.append(f'<edge id="{leg}_in" from="{leg}_from" to="c" numLanes="2" speed="{LIMIT_MPS}"/>')
        edges.append(f'<edge id="{leg}_out" from="c" to="{leg}_to" numLanes="2" speed="{LIMIT_MPS}"/>')
        for lane in (0, 1):
            connections.append(
                f'<connection from="{leg}_in" to="{OPPOSITE[leg]}_out" fromLane="{lane}" toLane="{lane}"/>')
    nodes.append('<node id="c" x="0" y="0" type="traffic_light"/>')
    for name, items in (("nodes", nodes), ("edges", edges), ("connections", connections)):
        (folder / f"i.{name[:3]}.xml").write_text(f"<{name}>" + "\n".join(items) + f"</{name}>")
    subprocess.run([netconvert, "-n", "i.nod.xml", "-e", "i.edg.xml", "-x", "i.con.xml", "-o", "i.net.xml",
                    "--no-turnarounds", "true", "--default.junctions.radius", str(RADIUS_M)], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def phases(folder, green):
    """Returns a tlLogic: north and south are green first, then east and west."""
    links = {}
    for connection in ElementTree.parse(folder / "i.net.xml").getroot().iter("connection"):
        if connection.get("tl"):
            links[int(connection.get("linkIndex"))] = connection.get("from").split("_")[0]
    text = f'<tlLogic id="c" type="static" programID="fixed" offset="0">'
    for group in (("north", "south"), ("east", "west")):
        for duration, letter in ((green, "G"), (3, "y"), (5, "r")):
            state = "".join(letter if links[k] in group else "r" for k in sorted(links))
            text += f'<phase duration="{duration}" state="{state}"/>'
    return text + "</tlLogic>"


def run_sumo(sumo, folder, green, seconds, loops):
    """Runs SUMO. Returns its output."""
    additional = phases(folder, green)
    if loops:
        for leg in LEGS:
            for lane in (0, 1):
                additional += f'<instantInductionLoop id="{leg}{lane}" lane="{leg}_in_{lane}" pos="-0.1" file="loop.xml"/>'
    (folder / "i.add.xml").write_text(f"<additional>{additional}</additional>")
    flows = "".join(
        f'<route id="{leg}" edges="{leg}_in {OPPOSITE[leg]}_out"/>' for leg in LEGS) + "".join(
        f'<flow id="{leg}{lane}" type="ctg" route="{leg}" begin="0" end="{seconds}" period="1.0" departLane="{lane}" '
        f'departSpeed="avg" departPos="base"/>' for leg in LEGS for lane in (0, 1))
    (folder / "i.rou.xml").write_text(f"<routes>{CTG}{flows}</routes>")
    # With --max-depart-delay 2, SUMO drops a vehicle that could not be inserted within 2 s. Otherwise the backlog would
    # grow and slow the simulation down.
    return subprocess.run([sumo, "-n", "i.net.xml", "-r", "i.rou.xml", "-a", "i.add.xml", "--step-length", "0.1", "--end",
                           str(seconds), "--no-step-log", "--duration-log.statistics", "--seed", "1",
                           "--max-depart-delay", "2", "--lanechange.duration", "0"], cwd=folder, check=True,
                          capture_output=True, text=True).stdout


def sumo_counts(sumo, folder, green):
    """Returns SUMO's vehicles in each cycle, by lane."""
    run_sumo(sumo, folder, green, cycle_of(green) * (WARMUP_CYCLES + CYCLES), True)
    times = {}
    for event in ElementTree.parse(folder / "loop.xml").getroot():
        if event.get("state") == "enter":
            times.setdefault(event.get("id"), []).append(float(event.get("time")))
    return [per_cycle(lane, green) for lane in times.values()]


def our_counts(programs, folder):
    """Returns our vehicles in each cycle, by green time and lane."""
    subprocess.run([programs / "stopline-calibrate", HERE / "intersection_greens.yaml", "--step", "I", "--parameters",
                    "table2", "--output", folder], check=True, stdout=subprocess.DEVNULL)
    times = {green: {} for green in GREENS_S}
    with open(folder / "differences.csv", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["detector"].endswith(" stop_line"):
                green = int(row["permutation"].split(" = ")[1].split()[0])
                times[green].setdefault(row["detector"], []).append(float(row["meso_s"]))
    return {green: [per_cycle(lane, green) for lane in lanes.values()] for green, lanes in times.items()}


def mean_of(lanes):
    return [sum(cycle) / len(lanes) for cycle in zip(*lanes)]


def compare_speed(sumo, programs, folder):
    sumo_output = run_sumo(sumo, folder, SPEED_GREEN_S, SPEED_S, False)
    theirs = float(re.search(r"UPS: ([0-9.]+)", sumo_output).group(1))
    sweep_output = subprocess.run([programs / "stopline-sweep", HERE / "intersection_speed.yaml", "--threads", "1", "--output",
                                   folder / "speed"], check=True, capture_output=True, text=True).stdout
    ours = 1e6 * float(re.search(r"([0-9.]+) million vehicle updates per second", sweep_output).group(1))
    print(f"vehicle updates per second: ours {ours:.3g}, SUMO {theirs:.3g} by its own output, ratio {ours / theirs:.0f}")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    found = find_sumo()
    if found is None:
        print("skipped: SUMO is not installed (pip install eclipse-sumo)")
        return 77
    programs = Path(sys.argv[1]).resolve()
    worst = 0.0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_network(found[1], folder)
        ours = our_counts(programs, folder / "ours")
        for green in GREENS_S:
            a = mean_of(ours[green])
            b = mean_of(sumo_counts(found[0], folder, green))
            worst = max([worst] + [abs(x - y) for x, y in zip(a, b)])
            print(f"green {green:2d} s, vehicles per lane: ours {[round(x, 1) for x in a]}, SUMO {[round(x, 1) for x in b]}")
        print(f"largest difference: {worst:.2f} vehicles per lane and cycle")
        if "--speed" in sys.argv:
            compare_speed(found[0], programs, folder)
    return 0 if worst <= 1.0 else 1


if __name__ == "__main__":
    sys.exit(main())
