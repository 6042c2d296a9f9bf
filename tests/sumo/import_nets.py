#!/usr/bin/env python3
"""Imports SUMO networks, runs them with random trips, and checks for violations.

    import_nets.py BIN [--fidelity meso|full] [--seeds N] [--only NAME] [--keep DIR] [--net FILE ROUTES[,ROUTES...]]...

BIN is the folder of stopline-run. The networks come from SUMO's netgenerate and from the SUMO package (pip install
eclipse-sumo), which is found by SUMO_HOME or as a Python package. --net replaces them by a network and its route files.
For each run the script prints the numbers of vehicles that entered, arrived, were teleported or missed a turn, the
backlog, gridlocks and violations. Exit codes: 0 no violations, 1 a run failed or has violations (overlaps, conflicts,
red-light entries, lost vehicles), 77 SUMO is not installed.
"""

import argparse
import csv
import os
import subprocess
import sys
import tempfile
from pathlib import Path

# Options of netgenerate, without the seed.
NETS = {
    "grid_1": "--grid --grid.number 4 --grid.length 150 --grid.attach-length 100 --default-junction-type traffic_light",
    "grid_2": "--grid --grid.number 4 --grid.length 180 --grid.attach-length 150 -L 2 --default-junction-type traffic_light",
    "grid_3": "--grid --grid.number 3 --grid.length 250 --grid.attach-length 200 -L 3 --turn-lanes 1 --default-junction-type traffic_light",
    "grid_opposites": "--grid --grid.number 3 --grid.length 200 --grid.attach-length 150 -L 2 --default-junction-type traffic_light"
    " --tls.layout incoming",
    "grid_priority": "--grid --grid.number 4 --grid.length 150 --grid.attach-length 100 --default-junction-type priority",
    "grid_right_before_left": "--grid --grid.number 4 --grid.length 150 --grid.attach-length 100"
    " --default-junction-type right_before_left",
    "grid_allway_stop": "--grid --grid.number 4 --grid.length 150 --grid.attach-length 100 --default-junction-type allway_stop",
    "spider": "--spider --spider.arm-number 6 --spider.circle-number 3 --spider.space-radius 120 --tls.guess",
    "spider_2": "--spider --spider.arm-number 5 --spider.circle-number 3 --spider.space-radius 150 -L 2"
    " --default-junction-type traffic_light",
    "random": "--rand --rand.iterations 60 --tls.guess --tls.guess.threshold 30",
    "random_2": "--rand --rand.iterations 60 -L 2 --tls.guess --tls.guess.threshold 30",
    "random_lanes": "--rand --rand.iterations 80 --rand.random-lanenumber -L 3 --default-junction-type traffic_light",
}
SEEDED = ("spider", "random")
# Networks in SUMO's folder, with the seconds between two trips. Several are parts of real cities.
SHIPPED = {
    "tools/game/A10KW/osm.net.xml": 1.0,  # a motorway
    "tools/game/DRT/osm.net.xml": 1.0,
    "tools/game/bs3d/bs.net.xml": 2.0,
    "tools/game/corridor/corridor.net.xml": 1.5,
    "tools/game/cross/cross.net.xml": 2.0,
    "tools/game/fkk_in/ingolstadt.net.xml.gz": 1.0,
    "tools/game/grid6/grid6.net.xml": 1.5,
    "tools/game/kuehne/kuehne.net.xml": 2.0,
    "tools/game/ramp/ramp.net.xml": 2.0,
    "tools/game/square/square.net.xml": 2.0,
    "tools/sumolib/scenario/scenarios/RiLSA1/rilsa1.net.xml": 2.0,
}
SECONDS = 900
PERIODS = {"grid_priority": 2.0, "grid_right_before_left": 2.0, "grid_allway_stop": 2.5, "random": 2.0, "spider": 2.0}


def sumo_home():
    if os.environ.get("SUMO_HOME"):
        return Path(os.environ["SUMO_HOME"])
    try:
        import sumo  # pylint: disable=import-outside-toplevel

        return Path(sumo.SUMO_HOME)
    except ImportError:
        return None


def make(home, folder, name, options, seed):
    """Writes a network and random trips. Returns the paths of both files."""
    net = folder / f"{name}.net.xml.gz"
    subprocess.run([home / "bin" / "netgenerate", *options.split(), "--seed", str(seed), "-o", net], check=True, capture_output=True)
    return net, make_trips(home, folder, name, net, PERIODS.get(name.rsplit("_s", 1)[0], 1.0), seed)


def make_trips(home, folder, name, net, period, seed):
    trips = folder / f"{name}.trips.xml"
    subprocess.run(
        [sys.executable, home / "tools" / "randomTrips.py", "-n", net, "-o", trips, "-e", str(SECONDS - 200), "-p", str(period),
         "--seed", str(seed), "--fringe-factor", "5", "--validate", "--trip-attributes", 'departLane="best" departSpeed="max"'],
        check=True, capture_output=True, env={**os.environ, "SUMO_HOME": str(home)}, cwd=folder)  # fmt: skip
    return trips


def run(binary, folder, name, net, routes, fidelity):
    scenario = folder / f"{name}.yaml"
    scenario.write_text(
        f"fidelity: {fidelity}\nduration: {SECONDS} s\n"
        f"network: {{kind: sumo, net: {net}, routes: [{routes}]}}\n"
        "populations: [CDG, {name: MIX, pattern: alternating, components: [{policy: CDG, share: 50 %},"
        " {policy: CTG-Ref, share: 50 %}]}, CTG-Ref]\nrules: {teleport_cycles: 3}\nmeasure: {window: 600 s}\n"
    )
    out = folder / f"out_{name}"
    result = subprocess.run(
        [binary / "stopline-run", scenario, "--no-figures", "--output", out], capture_output=True, text=True, check=False
    )
    if not (out / "summary.csv").is_file():
        return None, result.stderr.strip()
    with open(out / "summary.csv", encoding="utf-8") as file:
        return list(csv.DictReader(file)), result.stderr.strip()


def judge(name, rows, errors):
    """Prints a line for each population. Returns False if there is an error or a violation."""
    if rows is None:
        print(f"{name:28} {errors[:300]}")
        return False
    passed = True
    for row in rows:
        violations = {key: int(row[key]) for key in ("overlaps", "conflicts", "red_entries", "lost_vehicles") if int(row[key])}
        passed = passed and not violations
        print(
            f"{name:28} {row['population']:8} entered {row['entered']:>5} arrived {row['exited']:>5} teleported {row['teleported']:>4} "
            f"missed turns {row['missed_turns']:>4} backlog {row['backlog']:>4} gridlocks {row['gridlocks']:>3} travel time {row['travel_time_s']:>8} s "
            f"forced red entries {row['forced_red_entries']:>3} {violations or ''}",
            flush=True,
        )
    return passed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binary", type=Path)
    parser.add_argument("--fidelity", default="meso")
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--only", default="")
    parser.add_argument("--keep", type=Path)
    parser.add_argument("--net", nargs=2, action="append", default=[])
    options = parser.parse_args()
    home = sumo_home()
    if home is None:
        print("skipped: SUMO is not installed (pip install eclipse-sumo)")
        return 77
    passed = True
    with tempfile.TemporaryDirectory() as temporary:
        folder = (options.keep or Path(temporary)).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        binary = options.binary.resolve()
        for name, options_text in NETS.items() if not options.net else []:
            if options.only and options.only not in name:
                continue
            seeds = range(1, options.seeds + 1) if name.startswith(SEEDED) else [1]
            for seed in seeds:
                full_name = f"{name}_s{seed}"
                net, trips = make(home, folder, full_name, options_text, seed)
                passed = judge(full_name, *run(binary, folder, full_name, net, trips, options.fidelity)) and passed
        for path, period in SHIPPED.items() if not options.net else []:
            name = Path(path).parts[-2]
            if options.only and options.only not in name:
                continue
            if not (home / path).is_file():
                print(f"{name:28} is not part of this version of SUMO")
                continue
            trips = make_trips(home, folder, name, home / path, period, 1)
            passed = judge(name, *run(binary, folder, name, home / path, trips, options.fidelity)) and passed
        for net, routes in options.net:
            name = Path(net).name.split(".")[0]
            files = ", ".join(str(Path(file).resolve()) for file in routes.split(","))
            passed = judge(name, *run(binary, folder, name, Path(net).resolve(), files, options.fidelity)) and passed
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
