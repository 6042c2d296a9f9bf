#!/usr/bin/env python3
"""Finds vehicles that drive through each other in floating car data, independently of the simulation's own checks.

    bodies.py FCD [--length M] [--width M] [--list N]

FCD is a file of stopline-run --fcd, preferably with --record-interval '0.2 s'. A body covers the last 4 m of the path
of a vehicle's front and is 1 m wide. It is smaller than the vehicle, so rounding cannot cause a finding.
Prints the number of pairs that meet, and the first ones. Exit codes: 0 no bodies meet, 1 bodies meet.
"""

import argparse
import math
import sys
import xml.etree.ElementTree as ElementTree
from collections import defaultdict

POINT_SPACING_M = 0.7  # distance of two points of a path
JUMP_M = 1.0  # sideways step that counts as a lane change


def frames(file):
    """Yields the time and the vehicles (id, x, y, angle, speed, lane) of each step."""
    for _, element in ElementTree.iterparse(file):
        if element.tag == "timestep":
            yield float(element.get("time")), [
                (v.get("id"), float(v.get("x")), float(v.get("y")), math.radians(90.0 - float(v.get("angle"))), float(v.get("speed")), v.get("lane"))
                for v in element
            ]
            element.clear()


def trim(path, length_m):
    """Returns the newest part of a path with the given length, newest point first."""
    kept = [path[0]]
    remaining_m = length_m
    for point in path[1:]:
        step_m = math.dist(kept[-1], point)
        if step_m >= remaining_m:
            share = remaining_m / step_m if step_m > 0.0 else 0.0
            kept.append(tuple(a + share * (b - a) for a, b in zip(kept[-1], point)))
            return kept
        kept.append(point)
        remaining_m -= step_m
    return kept


def distance_m(point, a, b):
    """Returns the distance of a point from the segment a-b, m."""
    dx, dy = b[0] - a[0], b[1] - a[1]
    squared = dx * dx + dy * dy
    along = 0.0 if squared == 0.0 else max(0.0, min(1.0, ((point[0] - a[0]) * dx + (point[1] - a[1]) * dy) / squared))
    return math.hypot(point[0] - a[0] - along * dx, point[1] - a[1] - along * dy)


def segments_cross(a, b, c, d):
    def side(p, q, r):
        return (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])

    return side(a, b, c) * side(a, b, d) < 0.0 and side(c, d, a) * side(c, d, b) < 0.0


def path_distance_m(first, second):
    """Returns the smallest distance of two paths, m; 0 if they cross."""
    smallest = math.inf
    for a, b in zip(first, first[1:]):
        for c, d in zip(second, second[1:]):
            if segments_cross(a, b, c, d):
                return 0.0
            smallest = min(smallest, distance_m(a, c, d), distance_m(b, c, d), distance_m(c, a, b), distance_m(d, a, b))
    return smallest


class Bodies:
    """The bodies of all vehicles, as paths of points, newest point first."""

    def __init__(self, length_m):
        self.length_m = length_m
        self.paths = {}
        self.stopped = set()

    def move(self, vehicles, step_s):
        new_paths = {}
        for name, x, y, angle, speed, _ in vehicles:
            path = self.paths.get(name)
            if path is None or math.dist(path[0], (x, y)) > (speed + 2.0) * step_s + JUMP_M:
                path = [(x, y), (x - self.length_m * math.cos(angle), y - self.length_m * math.sin(angle))]
                self.stopped.discard(name)
            elif (x, y) == path[0]:
                self.stopped.add(name)
            else:
                behind = path[1:] if math.dist(path[1], (x, y)) < POINT_SPACING_M else path  # drop points that are too close
                path = trim([(x, y), *behind], self.length_m)
                self.stopped.discard(name)
            new_paths[name] = path
        self.paths = new_paths

    def pairs_nearby(self):
        """Yields pairs of vehicles that may meet. At least one of the two moves."""
        cell_m = 2.0 * self.length_m + 2.0  # fronts further apart cannot meet
        cells = defaultdict(list)
        for name, path in self.paths.items():
            cells[(int(path[0][0] // cell_m), int(path[0][1] // cell_m))].append(name)
        for (i, k), names in cells.items():
            for others in ((i, k), (i + 1, k), (i - 1, k + 1), (i, k + 1), (i + 1, k + 1)):
                for n, first in enumerate(names):
                    for second in names[n + 1 :] if others == (i, k) else cells.get(others, ()):
                        if first in self.stopped and second in self.stopped:
                            continue
                        if math.dist(self.paths[first][0], self.paths[second][0]) < cell_m:
                            yield (first, second) if first < second else (second, first)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("fcd")
    parser.add_argument("--length", type=float, default=4.0)
    parser.add_argument("--width", type=float, default=1.0)
    parser.add_argument("--list", type=int, default=10)
    options = parser.parse_args()
    bodies = Bodies(options.length)
    previous_s = None
    met = {}
    lanes = {}
    for time_s, vehicles in frames(options.fcd):
        bodies.move(vehicles, time_s - previous_s if previous_s is not None else 1.0)
        previous_s = time_s
        lanes = {v[0]: v[5] for v in vehicles}
        for pair in bodies.pairs_nearby():
            if pair not in met and path_distance_m(bodies.paths[pair[0]], bodies.paths[pair[1]]) < options.width:
                met[pair] = (time_s, lanes[pair[0]], lanes[pair[1]], bodies.paths[pair[0]][0])
    for pair, (time_s, first_lane, second_lane, point) in list(met.items())[: options.list]:
        print(f"{time_s:8.2f} s  {pair[0]} on {first_lane} and {pair[1]} on {second_lane}, at {point[0]:.1f} {point[1]:.1f}")
    print(f"{len(met)} pairs of bodies meet")
    return 1 if met else 0


if __name__ == "__main__":
    sys.exit(main())
