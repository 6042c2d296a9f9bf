#!/usr/bin/env python3
"""Compares the computing speed of the mesoscale mode and of SUMO on the grid of Section VI.C in the paper.

    grid.py FOLDER_OF_STOPLINE_PROGRAMS [--keep FOLDER]

The grid has 25 intersections, 15 s green, 5 % left turns and 10 % right turns. The script writes two SUMO networks: one
with two lanes per edge, and one in which every lane is a separate edge, so that SUMO needs no lane-change model. It
runs SUMO and stopline-benchmark alternately on one thread each, and prints the best number of vehicle updates per
second. SUMO drops vehicles that cannot be inserted, because a backlog would cost it computing time. --keep writes the
files to a folder. Exit codes: 0 done, 77 SUMO is not installed.
"""

import argparse
import json
import random
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from cross_check import LIMIT_MPS, find_sumo
from intersection import CTG

COLUMNS, ROWS = 5, 5
SPACING_M = {"x": 276.5, "y": 192.5}
RADIUS_M = 20.0
OUTER_LEG_M = RADIUS_M + 155.0
LANE_M = 3.2
GREEN_S, YELLOW_S, ALL_RED_S = 15, 3, 5
CYCLE_S = 2 * (GREEN_S + YELLOW_S + ALL_RED_S)
LEFT, RIGHT = 0.05, 0.10
SECONDS = 900
HEADWAY_S = 2.4  # of arrivals on each inlet lane; more vehicles than the network can take
ROUNDS = 3
DIRECTIONS = {"east": (1, 0), "north": (0, 1), "west": (-1, 0), "south": (0, -1)}  # each is a left turn from the one before
ORDER = list(DIRECTIONS)


def position(node):
    """Returns the coordinates of an intersection, or of the end of a street outside the grid, m."""
    column, row = node
    x = min(max(column, 0), COLUMNS - 1) * SPACING_M["x"] + (column - min(max(column, 0), COLUMNS - 1)) * OUTER_LEG_M
    y = min(max(row, 0), ROWS - 1) * SPACING_M["y"] + (row - min(max(row, 0), ROWS - 1)) * OUTER_LEG_M
    return x, y


def is_intersection(node):
    return 0 <= node[0] < COLUMNS and 0 <= node[1] < ROWS


def intersections():
    return [(c, r) for r in range(ROWS) for c in range(COLUMNS)]


def name(node):
    # Nodes outside the grid can have the number -1. Adding 1 avoids a minus sign in the name.
    return f"{node[0] + 1}_{node[1] + 1}"


def step(node, direction):
    return node[0] + DIRECTIONS[direction][0], node[1] + DIRECTIONS[direction][1]


def turn(direction, quarter):
    return ORDER[(ORDER.index(direction) + quarter) % 4]


class Network:
    """The SUMO network. With `split`, every lane is a separate edge. Lane 0 is the right lane."""

    def __init__(self, split):
        self.split = split
        self.streets = set()  # (from, to, direction)
        for node in intersections():
            for direction in DIRECTIONS:
                self.streets.add((node, step(node, direction), direction))
                self.streets.add((step(node, direction), node, turn(direction, 2)))

    def edge(self, start, end, lane):
        return f"{name(start)}to{name(end)}" + (f"lane{lane}" if self.split else "")

    def lane(self, lane):
        return 0 if self.split else lane

    def write(self, netconvert, folder):
        nodes = {node for street in self.streets for node in street[:2]}
        kinds = {node: "traffic_light" if is_intersection(node) else "dead_end" for node in nodes}
        lines = [f'<node id="{name(n)}" x="{position(n)[0]}" y="{position(n)[1]}" type="{kinds[n]}" radius="{RADIUS_M}"/>'
                 for n in sorted(nodes)]
        (folder / "grid.nod.xml").write_text("<nodes>\n" + "\n".join(lines) + "\n</nodes>\n")
        (folder / "grid.edg.xml").write_text("<edges>\n" + "\n".join(self.edges()) + "\n</edges>\n")
        (folder / "grid.con.xml").write_text("<connections>\n" + "\n".join(self.connections()) + "\n</connections>\n")
        subprocess.run([netconvert, "-n", "grid.nod.xml", "-e", "grid.edg.xml", "-x", "grid.con.xml", "-o", "grid.net.xml",
                        "--no-turnarounds", "true"], cwd=folder, check=True, stdout=subprocess.DEVNULL,
                       stderr=subprocess.DEVNULL)
        (folder / "grid.add.xml").write_text(f"<additional>\n{lights(folder)}\n</additional>\n")

    def edges(self):
        for start, end, direction in sorted(self.streets):
            if not self.split:
                yield (f'<edge id="{self.edge(start, end, 0)}" from="{name(start)}" to="{name(end)}" numLanes="2" '
                       f'speed="{LIMIT_MPS}"/>')
                continue
            for lane in (0, 1):
                right_m = (1.5 - lane) * LANE_M
                dx, dy = DIRECTIONS[direction]
                points = [(x + dy * right_m, y - dx * right_m) for x, y in (position(start), position(end))]
                shape = " ".join(f"{x:.2f},{y:.2f}" for x, y in points)
                yield (f'<edge id="{self.edge(start, end, lane)}" from="{name(start)}" to="{name(end)}" numLanes="1" '
                       f'speed="{LIMIT_MPS}" spreadType="center" shape="{shape}"/>')

    def connections(self):
        for start, node, direction in sorted(self.streets):
            if not is_intersection(node):
                continue
            for lane, quarter in ((0, 0), (0, 3), (1, 0), (1, 1)):
                after = step(node, turn(direction, quarter))
                yield (f'<connection from="{self.edge(start, node, lane)}" to="{self.edge(node, after, lane)}" '
                       f'fromLane="{self.lane(lane)}" toLane="{self.lane(lane)}"/>')

    def write_demand(self, folder):
        """Writes one vehicle per headway on each inlet lane. The turns of its trip are drawn at random."""
        draw = random.Random(1)
        vehicles = []
        for start, node, direction in sorted(self.streets):
            if is_intersection(start) or not is_intersection(node):
                continue
            for lane in (0, 1):
                first_s = draw.random() * HEADWAY_S
                for k in range(int(SECONDS / HEADWAY_S)):
                    edges = self.trip(start, node, direction, lane, draw)
                    vehicles.append((first_s + k * HEADWAY_S, lane, edges))
        lines = [f'<vehicle id="{k}" type="ctg" depart="{depart:.1f}" departLane="{self.lane(lane)}" departSpeed="avg" '
                 f'departPos="base"><route edges="{" ".join(edges)}"/></vehicle>'
                 for k, (depart, lane, edges) in enumerate(sorted(vehicles))]
        (folder / "grid.rou.xml").write_text(f"<routes>\n{CTG}\n" + "\n".join(lines) + "\n</routes>\n")

    def trip(self, start, node, direction, lane, draw):
        edges = [self.edge(start, node, lane)]
        while is_intersection(node):
            if lane == 0 and draw.random() < RIGHT:
                direction = turn(direction, 3)
            elif lane == 1 and draw.random() < LEFT:
                direction = turn(direction, 1)
            after = step(node, direction)
            edges.append(self.edge(node, after, lane))
            node = after
        return edges


def lights(folder):
    """Returns fixed-time programmes: east and west are green first, and left turns yield."""
    links = {}
    for connection in ElementTree.parse(folder / "grid.net.xml").getroot().iter("connection"):
        if connection.get("tl"):
            start, end = connection.get("from").split("lane")[0].split("to")
            east_west = start.split("_")[1] == end.split("_")[1]
            links.setdefault(connection.get("tl"), {})[int(connection.get("linkIndex"))] = (east_west, connection.get("dir"))
    text = []
    for light, by_index in sorted(links.items()):
        text.append(f'<tlLogic id="{light}" type="static" programID="fixed" offset="0">')
        for first in (True, False):
            for duration, letter in ((GREEN_S, "G"), (YELLOW_S, "y"), (ALL_RED_S, "r")):
                state = "".join("r" if by_index[k][0] != first else "g" if letter == "G" and by_index[k][1] == "l" else letter
                                for k in sorted(by_index))
                text.append(f'  <phase duration="{duration}" state="{state}"/>')
        text.append("</tlLogic>")
    return "\n".join(text)


def sumo_speed(sumo, folder):
    output = subprocess.run([sumo, "-n", "grid.net.xml", "-r", "grid.rou.xml", "-a", "grid.add.xml", "--step-length", "0.1", "--end",
                           str(SECONDS), "--no-step-log", "--duration-log.statistics", "--seed", "1", "--max-depart-delay", "2",
                           "--time-to-teleport", str(3 * CYCLE_S), "--ignore-junction-blocker", str(2 * GREEN_S)],
                          cwd=folder, check=True, capture_output=True, text=True).stdout
    inserted = re.search(r"Inserted: (\d+)", output).group(1)
    running = re.search(r"Running: (\d+)", output).group(1)
    return float(re.search(r"UPS: ([0-9.]+)", output).group(1)), f"{inserted} vehicles inserted, {running} at the end"


def our_speed(programs):
    output = subprocess.run([programs / "stopline-benchmark", "--benchmark_filter=meso_grid_25_intersections/CTG-Ref",
                           "--benchmark_format=json"], check=True, capture_output=True, text=True).stdout
    runs = [run for run in json.loads(output)["benchmarks"] if run["run_type"] == "iteration"]
    return 1.0 / min(run["s_per_update"] for run in runs), f"{runs[-1]['vehicles']:.0f} vehicles at the end"


def compare(sumo, netconvert, programs, folder):
    folders = {}
    for split, title in ((False, "SUMO, two lanes per edge"), (True, "SUMO, one lane per edge")):
        folders[title] = folder / ("split" if split else "plain")
        folders[title].mkdir(parents=True, exist_ok=True)
        network = Network(split)
        network.write(netconvert, folders[title])
        network.write_demand(folders[title])
    best = {}
    for _ in range(ROUNDS):
        for title, speed in [(t, sumo_speed(sumo, f)) for t, f in folders.items()] + [("ours", our_speed(programs))]:
            if title not in best or speed[0] > best[title][0]:
                best[title] = speed
            print(f"{title:26} {speed[0] / 1e6:7.2f} million updates per second, {speed[1]}", flush=True)
    for title in folders:
        print(f"ours is {best['ours'][0] / best[title][0]:.0f} times as fast as {title}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=Path)
    parser.add_argument("--keep", type=Path)
    options = parser.parse_args()
    found = find_sumo()
    if found is None:
        print("skipped: SUMO is not installed (pip install eclipse-sumo)")
        return 77
    with tempfile.TemporaryDirectory() as temporary:
        compare(found[0], found[1], options.programs.resolve(), options.keep or Path(temporary))
    return 0


if __name__ == "__main__":
    sys.exit(main())
