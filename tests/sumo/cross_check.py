#!/usr/bin/env python3
"""Compares the mesoscale mode with SUMO at a single light: vehicles that pass the stop line in each of ten cycles.

    cross_check.py STOPLINE_CALIBRATE

SUMO (pip install eclipse-sumo) uses its own Krauss model with the CTG parameters of Table 2 in the paper. Exit codes: 0
the counts differ by at most one vehicle in every cycle, 1 they differ by more, 77 SUMO is not installed.
"""

import csv
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

HERE = Path(__file__).resolve().parent
GREENS_S = [5, 10, 15, 20, 25, 30]
WARMUP_CYCLES = 3
CYCLES = 10
APPROACH_M = 1000.0
LIMIT_MPS = 50.0 / 3.6

NODES = """<nodes>
  <node id="a" x="0" y="0"/> <node id="b" x="{length}" y="0" type="traffic_light"/> <node id="c" x="{end}" y="0"/>
</nodes>"""
EDGES = """<edges>
  <edge id="in" from="a" to="b" numLanes="1" speed="{limit}"/> <edge id="out" from="b" to="c" numLanes="1" speed="{limit}"/>
</edges>"""
ADDITIONAL = """<additional>
  <tlLogic id="b" type="static" programID="fixed" offset="0">
    <phase duration="{green}" state="G"/> <phase duration="3" state="y"/> <phase duration="{red}" state="r"/>
  </tlLogic>
  <instantInductionLoop id="line" lane="in_0" pos="-0.1" file="loop.xml"/>
</additional>"""
ROUTES = """<routes>
  <vType id="ctg" carFollowModel="Krauss" accel="1.7" decel="4.7" tau="0.9" minGap="2.95" sigma="0.4" length="5.15"
         maxSpeed="40" speedFactor="1" speedDev="0"/>
  <route id="through" edges="in out"/>
  <flow id="queue" type="ctg" route="through" begin="0" period="1.0" number="2000" departSpeed="avg" departPos="base"/>
</routes>"""


def cycle_of(green):
    return 2 * (green + 8)


def per_cycle(times, green):
    """Returns the passages in each of the compared cycles."""
    cycle = cycle_of(green)
    counts = [0] * (WARMUP_CYCLES + CYCLES)
    for time in times:
        index = int(time // cycle)
        if index < len(counts):
            counts[index] += 1
    return counts[WARMUP_CYCLES:]


def sumo_times(sumo, netconvert, green, folder):
    cycle = cycle_of(green)
    (folder / "n.nod.xml").write_text(NODES.format(length=APPROACH_M, end=APPROACH_M + 500.0))
    (folder / "n.edg.xml").write_text(EDGES.format(limit=LIMIT_MPS))
    (folder / "n.add.xml").write_text(ADDITIONAL.format(green=green, red=cycle - green - 3))
    (folder / "n.rou.xml").write_text(ROUTES)
    subprocess.run([netconvert, "-n", "n.nod.xml", "-e", "n.edg.xml", "-o", "n.net.xml"], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL)
    subprocess.run([sumo, "-n", "n.net.xml", "-r", "n.rou.xml", "-a", "n.add.xml", "--step-length", "0.1", "--end",
                    str(cycle * (WARMUP_CYCLES + CYCLES)), "--no-step-log", "--seed", "1"], cwd=folder, check=True,
                   stdout=subprocess.DEVNULL)
    root = ElementTree.parse(folder / "loop.xml").getroot()
    return [float(event.get("time")) for event in root if event.get("state") == "enter"]


def stopline_times(program, folder):
    """Returns, by green time, the passage times of the mesoscale mode with the parameters of Table 2."""
    subprocess.run([program, HERE / "greens.yaml", "--step", "I", "--parameters", "table2", "--output", folder], check=True,
                   stdout=subprocess.DEVNULL)
    times = {green: [] for green in GREENS_S}
    with open(folder / "differences.csv", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            green = int(row["permutation"].split(" = ")[1].split()[0])
            times[green].append(float(row["meso_s"]))
    return times


def find_sumo():
    """Returns the paths of sumo and netconvert, or None."""
    try:
        import sumo as package
        folder = Path(package.SUMO_HOME) / "bin"
        return str(folder / "sumo"), str(folder / "netconvert")
    except (ImportError, AttributeError):  # AttributeError: a folder with this name, not the package
        found = shutil.which("sumo"), shutil.which("netconvert")
        return found if all(found) else None


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    programs = find_sumo()
    if programs is None:
        print("skipped: SUMO is not installed (pip install eclipse-sumo)")
        return 77
    worst = 0
    with tempfile.TemporaryDirectory() as name:
        times = stopline_times(sys.argv[1], Path(name) / "ours")
        for green in GREENS_S:
            theirs = per_cycle(sumo_times(*programs, green, Path(name)), green)
            ours = per_cycle(times[green], green)
            worst = max([worst] + [abs(a - b) for a, b in zip(ours, theirs)])
            print(f"green {green:2d} s: ours {ours}, SUMO {theirs}")
    print(f"largest difference: {worst} vehicles in a cycle")
    return 0 if worst <= 1 else 1


if __name__ == "__main__":
    sys.exit(main())
