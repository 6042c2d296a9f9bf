#!/usr/bin/env python3
"""Runs random scenarios and checks for violations.

    random_runs.py --bin FOLDER_OF_STOPLINE_PROGRAMS --kind KIND [--count 100] [--first 1] [--fleet] [--keep FOLDER]
                   [--set FIELD=VALUE]

Each scenario has a number, which is the seed of its random features: policies and their mixture, vehicle, signal and
demand. The kinds: `light` is a single light, `junction` one intersection, `arterial` a row of intersections, `streets` a
corridor of random_corridors.py, `imported` a network of tests/data. Each scenario runs in both fidelities. With --fleet,
the components of a population have vehicles and drivers of their own: cars, electric cars, lorries and buses. With
--keep, the files of the scenarios stay in a folder. Each --set FIELD=VALUE changes a field of all scenarios.

A run fails if the program reports a violation or a deadlock, if a movement starves, or if the program rejects the
scenario although it should accept it. Exit codes: 0 no run failed, 1 some runs failed.
"""

import argparse
import csv
import json
import random
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import random_corridors

VIOLATIONS = ("overlaps", "conflicts", "red_entries", "lost_vehicles", "deadlocks", "starvations")
PAPER_POLICIES = ["CDG", "CDG-6m", "CTG-Ref", "CTG-HCM", "CTG-HBS", "SWITCH-1", "SWITCH-2"]
VEHICLES = ["petrol_eu4_72kw", "petrol_eu4_84kw", "diesel_eu4_103kw", "electric_100kw"]
# Vehicle, driver, and whether its brakes respond so late that full dynamics refuses short constant distances.
FLEET = [("petrol_eu4_72kw", None, False), ("diesel_eu4_103kw", None, False), ("electric_100kw", None, False),
         ("rigid_lorry_12t", "lorry", True), ("articulated_lorry_35t", "lorry", True), ("city_bus_12m", "bus", True)]  # fmt: skip
IMPORTED = ["left_turns", "lights_grid", "roundabout", "short_edges", "speed_drop", "wrong_turn_lane"]
DATA = Path(__file__).resolve().parent.parent / "data"
LANES = {
    1: ["straight", "straight+left+right", "straight+left", "straight+right"],
    2: ["straight+left,straight+right", "left,straight+right", "straight,straight+right", "straight+left,straight"],
    3: ["straight+left,straight,straight+right", "left,straight,straight+right", "left,straight+left,straight+right"],
    4: ["left,straight,straight,straight+right", "straight+left,straight,straight,straight+right"],
}


def own_policy(rng, name):
    """Returns a random policy that no file contains."""
    gap_m = round(rng.uniform(2.0, 6.0), 2)  # full dynamics accepts no gap below 2 m
    law = rng.choice(["constant_distance", "constant_time", "switch_time_gap", "switch_distance"])
    policy = {"name": name, "law": law, "standstill_gap": f"{gap_m} m"}
    if law in ("constant_time", "switch_time_gap"):
        policy["time_gap"] = f"{rng.uniform(0.3, 2.0):.2f} s"
    if law.startswith("switch"):
        policy["switch_speed"] = f"{rng.randint(10, 40)} km/h"
    if law == "switch_distance":
        policy["reference_speed"] = "50 km/h"
        policy["reference_gap"] = f"{gap_m + rng.uniform(1.0, 20.0):.2f} m"
    return policy


def population(rng):
    """Returns a population, and the policies that it needs."""
    own = [own_policy(rng, f"own_{k}") for k in range(rng.choice([0, 0, 1, 2]))]
    names = rng.sample(PAPER_POLICIES, rng.randint(1, 3)) + [policy["name"] for policy in own]
    rng.shuffle(names)
    names = names[: rng.randint(1, 3)]
    own = [policy for policy in own if policy["name"] in names]
    shares = [100 // len(names)] * len(names)
    shares[0] += 100 - sum(shares)
    pattern = rng.choice(["random", "balanced"])
    components = [{"policy": name, "share": f"{share} %"} for name, share in zip(names, shares)]
    return {"name": "X", "pattern": pattern, "components": components}, own


def light(rng):
    """Returns the fields of a scenario with a single light."""
    return {
        "duration": "300 s",
        "network": {"kind": "approach", "approach": {
            "lanes": rng.randint(1, 3), "length": f"{rng.randint(900, 1400)} m", "exit_length": f"{rng.randint(200, 800)} m",
            "speed_limit": f"{rng.choice([30, 50, 70])} km/h", "gradient": f"{rng.randint(-3, 3)} %"}},
        "signal": {"first_green": f"{rng.randint(20, 100)} s", "green": f"{rng.randint(10, 60)} s", "yellow": "3 s",
                   "cycle": "90 s"},
        "demand": {"kind": "queue", "vehicles": rng.randint(5, 40)},
    }  # fmt: skip


def arterial(rng):
    """Returns the fields of a scenario with a row of intersections."""
    fields = junction(rng)
    layout = fields["network"]["intersection"]
    layout["approach_length"], layout["exit_length"] = "200 m", "100 m"
    fields["duration"] = "480 s"
    fields["network"] = {"kind": "grid", "intersection": layout, "grid": {
        "columns": rng.randint(2, 4), "rows": 1, "column_spacing": f"{rng.randint(200, 400)} m"}}
    fields["signal"]["offset"] = f"{rng.randint(0, 20)} s"
    fields["rules"] = {"keep_clear": "on", "teleport_cycles": rng.choice([0, 3])}
    fields["measure"] = {"window": "240 s"}
    return fields  # fmt: skip


def imported(rng, number, folder):
    """Returns the fields of a scenario with a network of tests/data. Half of them use SUMO's vehicle types."""
    name = rng.choice(IMPORTED)
    types = folder / f"types_{number}.add.xml"
    types.write_text(
        f'<additional><vType id="DEFAULT_VEHTYPE" length="{rng.choice([5, 9.5, 12])}" '
        f'accel="{rng.uniform(0.8, 3):.2f}" decel="{rng.uniform(3, 5):.2f}" tau="{rng.uniform(0.8, 2):.2f}" '
        f'minGap="{rng.uniform(2, 4):.2f}" maxSpeed="{rng.uniform(8, 40):.1f}" sigma="{rng.uniform(0, 1):.2f}"/></additional>\n')
    return {
        "duration": "400 s",
        "network": {"kind": "sumo", "net": str(DATA / f"{name}.net.xml"), "routes": [str(DATA / f"{name}.rou.xml")],
                    "additional": [str(types)], "vehicles": rng.choice(["from_scenario", "from_routes"])},
        "measure": {"window": "300 s"},
    }  # fmt: skip


def add_fleet(rng, mixture, own):
    """Gives the components of a population vehicles and drivers of their own."""
    short = {policy["name"] for policy in own if float(policy["standstill_gap"].split()[0]) < 4.5}
    for component in mixture["components"]:
        name, driver, brakes_late = rng.choice(FLEET)
        # At 70 km/h a brake that responds 0.1 s later needs a gap of 3.95 m.
        if brakes_late and (component["policy"] in short or component["policy"] not in ("CDG-6m", "CTG-HCM", "CTG-Ref")):
            component["policy"] = rng.choice(["CDG-6m", "CTG-HCM", "CTG-Ref"])
        if rng.random() < 0.2 and not brakes_late:
            component["policy"] = "HUMAN"
        component["vehicle"] = name
        if driver:
            component["driver"] = driver


def junction(rng):
    """Returns the fields of a scenario with one intersection."""
    lanes = rng.choice(LANES[rng.randint(1, 4)]).split(",")
    turn = {side: f"{rng.choice([0, 10, 20, 40])} %"
            for side in ("left", "right") if any(side in lane and "+" in lane for lane in lanes)}  # fmt: skip
    saturated = rng.random() < 0.7
    demand = {"kind": "saturated", "start": rng.choice(["queued", "empty"])} if saturated else {
        "kind": "rate", "inflow": f"{rng.randint(100, 4000)} veh/h"}
    return {
        "duration": "400 s",
        "network": {"kind": "intersection", "intersection": {
            "lanes": [{"movements": lane} for lane in lanes], "radius": f"{rng.randint(20, 30)} m",
            "approach_length": f"{rng.randint(80, 300)} m", "exit_length": f"{rng.randint(50, 200)} m",
            "speed_limit": f"{rng.choice([30, 50, 70])} km/h", "turn_speed": f"{rng.randint(5, 10)} m/s"}},
        "signal": {"green": f"{rng.randint(8, 40)} s", "yellow": f"{rng.randint(3, 5)} s",
                   "all_red": f"{rng.randint(1, 6)} s"},
        "demand": {**demand, **turn},
    }  # fmt: skip


def streets(rng, number, folder):
    """Returns the fields of a scenario with a random corridor."""
    file, _ = random_corridors.write_streets(number, folder)
    return {
        "duration": "600 s",
        "network": {"kind": "streets", "streets": f"./{file.name}"},
        "demand": {"kind": "saturated", "start": "empty"},
        "rules": {"teleport_cycles": rng.choice([0, 3]), "pass_blocker_greens": rng.choice([0, 2])},
        "measure": {"area_margin": "20 m", "window": "300 s"},
    }


def scenario(kind, number, folder, fleet):
    rng = random.Random(f"{kind} {number}")
    simple = {"light": light, "junction": junction, "arterial": arterial}
    fields = simple[kind](rng) if kind in simple else {"streets": streets, "imported": imported}[kind](rng, number, folder)
    mixture, policies = population(rng)
    if fleet:
        add_fleet(rng, mixture, policies)
    driver = {"base": "startup_kit", "free_drive": {"hesitation": f"{rng.choice([0, 0.5, 1.0])} s"}}
    return {"title": f"Random {kind} {number}", "seed": number, "step": "20 ms", **fields, "policies": policies,
            "populations": [mixture], "vehicle": rng.choice(VEHICLES), "driver": driver}  # fmt: skip


def problem(binary, file, overrides, output):
    """Runs a scenario. Returns what is wrong with the run, or an empty text."""
    command = [binary / "stopline-run", file, "--no-figures", "--threads", "1", "--output", output]  # fmt: skip
    for override in overrides:
        command += ["--set", override]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    summary = output / "summary.csv"
    if not summary.is_file():
        return f"exit code {result.returncode}: {result.stderr.strip()[:300]}"
    with open(summary, encoding="utf-8") as table:
        row = next(csv.DictReader(table))
    found = {key: row[key] for key in VIOLATIONS if row.get(key, "0") not in ("0", "")}
    if result.returncode not in (0, 1) or (result.returncode == 1 and not found):
        return f"exit code {result.returncode}: {result.stderr.strip()[:300]}"
    return ", ".join(f"{key} {value}" for key, value in found.items())


def run(options, folder, number):
    """Runs one scenario in both fidelities. Returns the lines about failed runs."""
    file = folder / f"{options.kind}_{number}.yaml"
    file.write_text(json.dumps(scenario(options.kind, number, folder, options.fleet), indent=1))
    failed = []
    for fidelity in options.fidelity or ["meso", "full"]:
        settings = [f"fidelity={fidelity}", *options.set]
        if options.kind == "light" and fidelity == "meso":
            settings.append("network.approach.gradient=0 %")  # only full dynamics has slopes
        text = problem(options.bin, file, settings, folder / f"{options.kind}_{number}_{fidelity}")
        if text:
            failed.append(f"{options.kind} {number}, {fidelity}: {text}")
    return failed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=Path, required=True, help="folder of the Stopline programs")
    parser.add_argument("--kind", choices=["light", "junction", "arterial", "streets", "imported"],
                        required=True, help="kind of network")
    parser.add_argument("--fleet", action="store_true", help="vehicles and drivers of several kinds")
    parser.add_argument("--fidelity", choices=["meso", "full"], action="append", help="default: both")
    parser.add_argument("--count", type=int, default=100, help="number of scenarios (default: 100)")
    parser.add_argument("--first", type=int, default=1, help="number of the first scenario (default: 1)")
    parser.add_argument("--jobs", type=int, default=2, help="runs at the same time (default: 2)")
    parser.add_argument("--set", metavar="FIELD=VALUE", action="append", default=[],
                        help="override of a field in all scenarios, as with stopline-run")
    parser.add_argument("--keep", type=Path, help="folder for scenarios and results (default: a temporary one)")
    options = parser.parse_args()
    options.bin = options.bin.resolve()
    failed = []
    with tempfile.TemporaryDirectory() as temporary, ThreadPoolExecutor(options.jobs) as pool:
        folder = (options.keep or Path(temporary)).resolve()
        folder.mkdir(parents=True, exist_ok=True)
        numbers = range(options.first, options.first + options.count)
        for done, lines in enumerate(pool.map(lambda number: run(options, folder, number), numbers), 1):
            failed += lines
            for line in lines:
                print(line, flush=True)
            if done % 50 == 0:
                print(f"{done} of {options.count} scenarios, {len(failed)} failed runs", flush=True)
    print(f"{options.count} scenarios, {len(failed)} failed runs")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
