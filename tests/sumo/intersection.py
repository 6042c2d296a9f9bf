#!/usr/bin/env python3
"""Compares the mesoscale mode with SUMO at the reference intersection, with the paper's parameters and without turns.

    intersection.py FOLDER_OF_STOPLINE_PROGRAMS [--speed]

Counts the vehicles past the eight stop lines in each of ten cycles; with --speed also vehicle updates a second of both programs,
one thread each, side by side. Exit codes: 0 within one vehicle a lane and cycle (mean of the lanes), 1 not, 77 SUMO is not installed.
"""

import csv
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from cross_check import CYCLES, GREENS_S, HERE, LIMIT_MPS, WARMUP_CYCLES, cycle_of, find_sumo, per_cycle

ARMS = {"north": (0, 1), "east": (1, 0), "south": (0, -1), "west": (-1, 0)}
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
    for arm, (x, y) in ARMS.items():
        far = RADIUS_M + APPROACH_M
        near = RADIUS_M + EXIT_M
        nodes.append(f'<node id="{arm}_from" x="{x * far}" y="{y * far}"/>')
        nodes.append(f'<node id="{arm}_to" x="{x * near}" y="{y * near}"/>')
        edges.append(f'<edge id="{arm}_in" from="{arm}_from" to="c" numLanes="2" speed="{LIMIT_MPS}"/>')
        edges.append(f'<edge id="{arm}_out" from="c" to="{arm}_to" numLanes="2" speed="{LIMIT_MPS}"/>')
        for lane in (0, 1):
            connections.append(
                f'<connection from="{arm}_in" to="{OPPOSITE[arm]}_out" fromLane="{lane}" toLane="{lane}"/>')
    nodes.append('<node id="c" x="0" y="0" type="traffic_light"/>')
    for name, items in (("nodes", nodes), ("edges", edges), ("connections", connections)):
        (folder / f"i.{name[:3]}.xml").write_text(f"<{name}>" + "\n".join(items) + f"</{name}>")
    subprocess.run([netconvert, "-n", "i.nod.xml", "-e", "i.edg.xml", "-x", "i.con.xml", "-o", "i.net.xml",
                    "--no-turnarounds", "true", "--default.junctions.radius", str(RADIUS_M)], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def phases(folder, green):
    """A tlLogic with north and south first, then east and west, as at the reference intersection."""
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
    """SUMO's own text of what it did."""
    added = phases(folder, green)
    if loops:
        for arm in ARMS:
            for lane in (0, 1):
                added += f'<instantInductionLoop id="{arm}{lane}" lane="{arm}_in_{lane}" pos="-0.1" file="loop.xml"/>'
    (folder / "i.add.xml").write_text(f"<additional>{added}</additional>")
    flows = "".join(
        f'<route id="{arm}" edges="{arm}_in {OPPOSITE[arm]}_out"/>' for arm in ARMS) + "".join(
        f'<flow id="{arm}{lane}" type="ctg" route="{arm}" begin="0" end="{seconds}" period="1.0" departLane="{lane}" '
        f'departSpeed="avg" departPos="base"/>' for arm in ARMS for lane in (0, 1))
    (folder / "i.rou.xml").write_text(f"<routes>{CTG}{flows}</routes>")
    # Vehicles that find no place are dropped: a growing backlog would cost SUMO time.
    return subprocess.run([sumo, "-n", "i.net.xml", "-r", "i.rou.xml", "-a", "i.add.xml", "--step-length", "0.1", "--end",
                           str(seconds), "--no-step-log", "--duration-log.statistics", "--seed", "1",
                           "--max-depart-delay", "2", "--lanechange.duration", "0"], cwd=folder, check=True,
                          capture_output=True, text=True).stdout


def sumo_counts(sumo, folder, green):
    """By lane, vehicles in each cycle."""
    run_sumo(sumo, folder, green, cycle_of(green) * (WARMUP_CYCLES + CYCLES), True)
    times = {}
    for event in ElementTree.parse(folder / "loop.xml").getroot():
        if event.get("state") == "enter":
            times.setdefault(event.get("id"), []).append(float(event.get("time")))
    return [per_cycle(lane, green) for lane in times.values()]


def our_counts(programs, folder):
    """By green time and lane, vehicles in each cycle."""
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
    said = run_sumo(sumo, folder, SPEED_GREEN_S, SPEED_S, False)
    theirs = float(re.search(r"UPS: ([0-9.]+)", said).group(1))
    ours = subprocess.run([programs / "stopline-sweep", HERE / "intersection_speed.yaml", "--threads", "1", "--output",
                           folder / "speed"], check=True, capture_output=True, text=True).stdout
    ups = 1e6 * float(re.search(r"([0-9.]+) million vehicle updates per second", ours).group(1))
    print(f"vehicle updates a second: ours {ups:.3g}, SUMO {theirs:.3g} (as it says itself): {ups / theirs:.0f} times")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    found = find_sumo()
    if found is None:
        print("SUMO is not installed (pip install eclipse-sumo): skipped")
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
            print(f"green {green:2d} s, vehicles a lane: ours {[round(x, 1) for x in a]}, SUMO {[round(x, 1) for x in b]}")
        print(f"largest difference: {worst:.2f} vehicles a lane and cycle")
        if "--speed" in sys.argv:
            compare_speed(found[0], programs, folder)
    return 0 if worst <= 1.0 else 1


if __name__ == "__main__":
    sys.exit(main())
