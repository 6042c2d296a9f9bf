#!/usr/bin/env python3
"""Looks for vehicles that drive through each other in floating car data, without asking the simulation what it thinks of it.

    bodies.py FCD [--length M] [--width M] [--list N]

FCD is a file of stopline-run --fcd, best with --record-interval '0.2 s'. A body is the last 4 m of the path of a front, and 1 m wide: both less
than those of the vehicles, so that what is found is no matter of rounding. Exit code 1 where two bodies meet; prints how many pairs, and the first.
"""

import argparse
import math
import sys
import xml.etree.ElementTree as ElementTree
from collections import defaultdict

APART_M = 0.7  # points of a path
JUMP_M = 1.0  # sideways in a step: a change of lanes


def frames(file):
    """Time and vehicles (id, x, y, angle, speed, lane) of each step."""
    for _, element in ElementTree.iterparse(file):
        if element.tag == "timestep":
            yield float(element.get("time")), [
                (v.get("id"), float(v.get("x")), float(v.get("y")), math.radians(90.0 - float(v.get("angle"))), float(v.get("speed")), v.get("lane"))
                for v in element
            ]
            element.clear()


def trim(path, length_m):
    """The end of a path, newest point first."""
    kept = [path[0]]
    left_m = length_m
    for point in path[1:]:
        step_m = math.dist(kept[-1], point)
        if step_m >= left_m:
            share = left_m / step_m if step_m > 0.0 else 0.0
            kept.append(tuple(a + share * (b - a) for a, b in zip(kept[-1], point)))
            return kept
        kept.append(point)
        left_m -= step_m
    return kept


def distance_m(point, a, b):
    dx, dy = b[0] - a[0], b[1] - a[1]
    squared = dx * dx + dy * dy
    along = 0.0 if squared == 0.0 else max(0.0, min(1.0, ((point[0] - a[0]) * dx + (point[1] - a[1]) * dy) / squared))
    return math.hypot(point[0] - a[0] - along * dx, point[1] - a[1] - along * dy)


def crossing(a, b, c, d):
    def side(p, q, r):
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    return side(a, b, c) * side(a, b, d) < 0.0 and side(c, d, a) * side(c, d, b) < 0.0


def apart_m(one, two):
    least = math.inf
    for a, b in zip(one, one[1:]):
        for c, d in zip(two, two[1:]):
            if crossing(a, b, c, d):
                return 0.0
            least = min(least, distance_m(a, c, d), distance_m(b, c, d), distance_m(c, a, b), distance_m(d, a, b))
    return least


class Bodies:
    """Of all vehicles, as paths of points, newest first."""

    def __init__(self, length_m):
        self.length_m = length_m
        self.paths = {}
        self.still = set()

    def move(self, vehicles, step_s):
        moved = {}
        for name, x, y, angle, speed, _ in vehicles:
            path = self.paths.get(name)
            if path is None or math.dist(path[0], (x, y)) > (speed + 2.0) * step_s + JUMP_M:
                path = [(x, y), (x - self.length_m * math.cos(angle), y - self.length_m * math.sin(angle))]
                self.still.discard(name)
            elif (x, y) == path[0]:
                self.still.add(name)
            else:
                behind = path[1:] if math.dist(path[1], (x, y)) < APART_M else path  # no more points than it needs
                path = trim([(x, y), *behind], self.length_m)
                self.still.discard(name)
            moved[name] = path
        self.paths = moved

    def near(self):
        """Pairs of names that may meet and of which one moves."""
        cell_m = 2.0 * self.length_m + 2.0  # fronts further apart cannot
        cells = defaultdict(list)
        for name, path in self.paths.items():
            cells[(int(path[0][0] // cell_m), int(path[0][1] // cell_m))].append(name)
        for (i, k), names in cells.items():
            for others in ((i, k), (i + 1, k), (i - 1, k + 1), (i, k + 1), (i + 1, k + 1)):
                for n, one in enumerate(names):
                    for two in names[n + 1 :] if others == (i, k) else cells.get(others, ()):
                        if one in self.still and two in self.still:
                            continue
                        if math.dist(self.paths[one][0], self.paths[two][0]) < cell_m:
                            yield (one, two) if one < two else (two, one)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fcd")
    parser.add_argument("--length", type=float, default=4.0)
    parser.add_argument("--width", type=float, default=1.0)
    parser.add_argument("--list", type=int, default=10)
    options = parser.parse_args()
    bodies = Bodies(options.length)
    before_s = None
    met = {}
    lanes = {}
    for time_s, vehicles in frames(options.fcd):
        bodies.move(vehicles, time_s - before_s if before_s is not None else 1.0)
        before_s = time_s
        lanes = {v[0]: v[5] for v in vehicles}
        for pair in bodies.near():
            if pair not in met and apart_m(bodies.paths[pair[0]], bodies.paths[pair[1]]) < options.width:
                met[pair] = (time_s, lanes[pair[0]], lanes[pair[1]], bodies.paths[pair[0]][0])
    for pair, (time_s, one, two, at) in list(met.items())[: options.list]:
        print(f"{time_s:8.2f} s  {pair[0]} on {one} and {pair[1]} on {two}, at {at[0]:.1f} {at[1]:.1f}")
    print(f"{len(met)} pairs of bodies met")
    return 1 if met else 0


if __name__ == "__main__":
    sys.exit(main())
