#!/usr/bin/env python3
"""Compares the mesoscale mode with SUMO on random corridors (see corridor.py).

    random_corridors.py --bin FOLDER_OF_STOPLINE_PROGRAMS [--count 20] [--first 1]

Each corridor has a number, which is the seed of its random features: 3 to 6 intersections, 2 to 4 lanes per direction,
links of 120 to 500 m, 5 to 30 % of each turn, some pockets, some additional right-turn lanes, and some intersections
with one minor leg only. --first is the number of the first corridor. The streets files stay in the output folder;
corridor.py --layout FILE compares one of them in detail.

Exit codes: 0 the mean of the absolute differences in throughput is at most 5 %, no difference is above 12 %, and our
runs report no violation; 1 one of these is missed; 77 SUMO is not installed.
"""

import argparse
import csv
import random
import sys
from pathlib import Path

import corridor
import street_tables
from cross_check import HERE, find_sumo

MEAN_PERCENT = 5.0
WORST_PERCENT = 12.0
YELLOW_S = 3


def lane(movements, pocket_m=0):
    return f"{{movements: {movements}{f', pocket: {pocket_m} m' if pocket_m else ''}}}"


def without(lanes, turn):
    """Removes a turn from lanes, and the lanes that only allow this turn."""
    kept = []
    for movements, pocket_m in lanes:
        movements = "+".join(one for one in movements.split("+") if one != turn)
        if movements:
            kept.append((movements, pocket_m))
    return kept


def major_lanes(rng, lanes, shortest_m):
    """Returns the approach lanes of a major leg, from the left, as pairs of movements and length of the pocket."""
    through = [["straight"] for _ in range(lanes)]
    pocket = rng.random() < 0.4
    if not pocket:
        through[0].append("left")
    additional = rng.random() < 0.2  # a lane for right turns that begins behind the intersection upstream
    if not additional:
        through[-1].append("right")
    result = [("+".join(movements), 0) for movements in through]
    if pocket:
        result.insert(0, ("left", rng.randrange(30, min(90, int(shortest_m) - 20), 10)))
    if additional:
        result.append(("right", 0))
    return result


def turns(rng, lanes):
    """Returns the text of the turn shares. Straight on keeps at least 40 %, or 0 % without a lane for it."""
    allowed = {turn for movements, _ in lanes for turn in movements.split("+")}
    left, right = rng.randint(5, 30), rng.randint(5, 30)
    left, right = left if "left" in allowed else 0, right if "right" in allowed else 0
    if "straight" not in allowed:
        left = round(100 * left / (left + right))
        right = 100 - left
    return "".join(f", {turn}: {share} %" for turn, share in (("right", right), ("left", left)) if share)


def leg(side, lanes, exits, shares, more=""):
    listed = ", ".join(lane(*one) for one in lanes)
    return f"  - {{from: {side}, lanes: [{listed}], exits: {exits}{shares}{more}}}\n"


def programme(rng, cycle_s, has_pocket):
    clearance_s = rng.randint(3, 9)
    protected_s = rng.choice([0, 0, 4]) if has_pocket else 0
    green_s = cycle_s - 2 * YELLOW_S - 2 * clearance_s - protected_s
    minor_s = round(green_s * rng.uniform(0.25, 0.45))
    steps = {"major_green": green_s - minor_s, "major_yellow": YELLOW_S, "major_clearance": clearance_s,
             "protected_left": protected_s, "minor_green": minor_s, "minor_yellow": YELLOW_S,
             "minor_clearance": clearance_s}
    return ", ".join(f"{name}: {value} s" for name, value in steps.items())


def streets_text(seed):
    """Returns a random streets file, and a short description."""
    rng = random.Random(f"corridor {seed}")
    count, lanes, cycle_s = rng.randint(3, 6), rng.randint(2, 4), rng.choice([60, 70, 80, 90])
    text = (f"# Random corridor {seed} (tests/sumo/random_corridors.py).\nmedian: 4 m\nlane_width: 3.5 m\n"
            "turn_speed: 7 m/s\nintersections:\n")
    x_m, links_m, pockets = 0, [], 0
    link_m = 300
    for k in range(count):
        next_m = rng.randint(120, 500)
        west, east = major_lanes(rng, lanes, link_m), major_lanes(rng, lanes, next_m if k + 1 < count else 300)
        minor = rng.choice([1, 1, 2])
        own = [("straight+left+right", 0)] if minor == 1 else [("straight+left", 0), ("straight+right", 0)]
        north, south = own, list(own)
        missing = rng.choice(["north", "south", "", "", "", "", "", ""])
        if missing == "north":
            west, east, south = without(west, "left"), without(east, "right"), without(south, "straight")
        if missing == "south":
            west, east, north = without(west, "right"), without(east, "left"), without(north, "straight")
        pockets += sum(pocket_m > 0 for _, pocket_m in west + east)
        widest = max(len(west), len(east)) * 3.5 + 2 + 2
        radius_m = max(20, widest)
        x_m += radius_m if k == 0 else links_m[-1] + radius_m
        text += (f"- name: i{k + 1}\n  x: {x_m:g} m\n  radius: {radius_m:g} m\n  offset: {rng.randrange(cycle_s)} s\n"
                 f"  programme: {{{programme(rng, cycle_s, any(pocket for _, pocket in west + east))}}}\n  legs:\n")
        text += leg("west", west, lanes, turns(rng, west))
        text += leg("east", east, lanes, turns(rng, east))
        limit = rng.choice(["", ", speed_limit: 30 km/h"])
        if missing != "north":
            text += leg("north", north, minor, turns(rng, north), limit)
        if missing != "south":
            text += leg("south", south, minor, turns(rng, south), limit)
        x_m += radius_m
        links_m.append(next_m)
        link_m = next_m
    links = "/".join(str(link) for link in links_m[:-1])
    return text, f"{lanes} lanes, links {links} m, {pockets} pockets, cycle {cycle_s} s"


def write_streets(number, output):
    """Writes the streets file of one corridor. Returns the file and the description."""
    text, description = streets_text(number)
    file = output / f"corridor_{number}.yaml"
    file.write_text(text)
    return file, description


def compare_all(options, sumo, output):
    """Runs all corridors and prints a row for each. Returns the Comparisons."""
    results = []
    print(street_tables.SHORT_HEADING)
    for number in range(options.first, options.first + options.count):
        file, description = write_streets(number, output)
        options.layout = str(file)
        for policy in options.policy or ["CTG"]:
            result = corridor.table_of(options, f"corridor {number}, {policy}", policy, sumo)
            (output / f"corridor_{number}_{policy}.txt").write_text(result.text())
            print(f"{result.short_line()}   {description}", flush=True)
            results.append(result)
    return results


def write_csv(file, results):
    rows = [(result.name, *result.total, result.difference_percent, result.worst_lane_difference,
             result.ours.teleported, result.sumo.teleported) for result in results]
    with open(file, "w", newline="", encoding="utf-8") as table:
        csv.writer(table).writerows([("corridor", "ours_per_minute", "sumo_per_minute", "difference_percent",
                                      "worst_lane_difference_per_cycle", "ours_teleported", "sumo_teleported"), *rows])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=20, help="number of corridors (default: 20)")
    parser.add_argument("--first", type=int, default=1, help="number of the first corridor (default: 1)")
    parser.add_argument("--write-only", action="store_true", help="write the streets files and end")
    corridor.add_run_options(parser)
    parser.set_defaults(scenario=HERE.parents[1] / "scenarios" / "berlin.yaml", seeds=1, duration=1200, warm_up=300)
    options = parser.parse_args()
    output = (options.output or Path("out/random_corridors")).resolve()
    output.mkdir(parents=True, exist_ok=True)
    if options.write_only:
        for number in range(options.first, options.first + options.count):
            print("{}: {}".format(*write_streets(number, output)))
        return 0
    found = find_sumo()
    if found is None:
        print("skipped: SUMO is not installed (pip install eclipse-sumo)")
        return 77
    options.bin = options.bin.resolve()
    results = compare_all(options, found[0], output)
    write_csv(output / "random_corridors.csv", results)
    differences = [result.difference_percent for result in results]
    mean_percent = street_tables.mean(map(abs, differences))
    worst = max(results, key=lambda result: abs(result.difference_percent))
    print(f"throughput: mean difference {street_tables.mean(differences):+.1f} %, mean absolute difference "
          f"{mean_percent:.1f} %, largest {worst.difference_percent:+.1f} % ({worst.name})")
    faults = [f"{result.name}: {note}" for result in results for note in result.notes()]
    print("".join(f"MISSED: {fault}\n" for fault in faults), end="")
    return 1 if mean_percent > MEAN_PERCENT or abs(worst.difference_percent) > WORST_PERCENT or faults else 0


if __name__ == "__main__":
    sys.exit(main())
