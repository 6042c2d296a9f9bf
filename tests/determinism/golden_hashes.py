#!/usr/bin/env python3
"""Runs short simulations and compares the hashes of their states and result tables with golden_hashes.csv.

    golden_hashes.py BIN [--update] [--only TEXT]

BIN is the folder of the programs. Each run in RUNS is executed once. Its row in golden_hashes.csv holds

  state_hash    a hash of the final states of all populations, as the program reports them
  tables_hash   a hash of the numbers in all result tables. The hash ignores text, so that a column or a delay cause can
                be renamed.

A run with threads > 1 shares the row of the same run on one thread: both must give the same hashes. --update rewrites the
file. Use it only for an intended change of behaviour, and say in the commit message which rows changed and why.
"""

import argparse
import concurrent.futures
import csv
import hashlib
import json
import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
TABLE = HERE / "golden_hashes.csv"
HEADER = ["run", "state_hash", "tables_hash"]


@dataclass
class Run:
    name: str
    scenario: str  # in scenarios/, without .yaml
    settings: dict = field(default_factory=dict)
    threads: int = 1
    program: str = "stopline-run"
    # Columns of summary.csv that count the situation to be tested, such as gridlocks. Each must be above 0 in some row.
    situation: tuple = ()


def population(policy):
    return {"populations": f"[{policy}]", "measure.baseline": policy}


def sumo(name):
    data = SOURCE / "tests" / "data"
    return {"network": f"{{kind: sumo, net: {data}/{name}.net.xml, routes: [{data}/{name}.rou.xml]}}"}


SHORT_LIGHT = {"duration": "110 s", "signal.first_green": "60 s", "signal.green": "30 s", "demand.vehicles": "18",
               "network.approach.length": "400 m", "measure.green": "[5 s, 10 s, 20 s]"}
SHORT_STREET = {"duration": "600 s", "measure.window": "300 s", "measure.time_space": "200 s"}
SHORT_GRID = {"duration": "420 s", "measure.window": "240 s"}
SMALL_GRID = {**SHORT_GRID, "network.grid.columns": "3", "network.grid.rows": "3"}
FULL = {"fidelity": "full"}
MESO = {"fidelity": "meso"}
GRIDLOCK = {"duration": "900 s", "measure.window": "600 s", "signal.green": "25 s", "demand.left": "10 %",
            "demand.right": "30 %", **population("CDG")}
QUICK_CYCLES = {"measure.cycles": "2", "step": "20 ms"}
MIXED = {"populations": "[CTG-Ref, {name: MIX, pattern: alternating, components: [{policy: CDG, share: 50 %}, "
                        "{policy: CTG-Ref, share: 50 %}]}]", "measure.baseline": "CTG-Ref"}
# Vehicles from the south and west turn, and must change lanes for it.
MATRIX = {**SMALL_GRID, **FULL, "duration": "240 s", "measure.window": "120 s", **population("CTG-Ref"),
          "demand": f"{{kind: od, od: {SOURCE}/tests/data/grid_matrix.csv, arrivals: platooned}}"}
IMPORT_BASE = {"fidelity": "meso", "rules": "{teleport_cycles: 3}", **MIXED}
TWO_STREETS = {"network.streets": f"{SOURCE}/tests/data/two_intersections.yaml", "duration": "600 s"}
OWN_LAWS = {
    "policies": "[{name: PROGRESSIVE, law: formula, standstill_gap: 2.95 m, mesoscale: time_gap, "
                'gap: "s0 + 0.4 s * v + 0.01 s2/m * v^2"}, '
                "{name: MEASURED, law: table, standstill_gap: 2.95 m, mesoscale: constant_distance, "
                "gaps: {20 km/h: 4 m, 40 km/h: 7 m, 50 km/h: 11 m}}]",
    "populations": "[PROGRESSIVE, MEASURED, CTG-Ref]"}
POLICIES = ["CDG", "CDG-6m", "CTG-Ref", "CTG-HCM", "CTG-HBS", "SWITCH-1", "SWITCH-1-6m", "SWITCH-2"]


def policy_runs():
    for policy in POLICIES:
        yield Run(f"light_full_{policy}", "single_light", {**SHORT_LIGHT, **population(policy)})
        yield Run(f"light_meso_{policy}", "single_light", {**SHORT_LIGHT, **MESO, **population(policy)})


def imported(name, scenario_settings, threads=1):
    return Run(name, "golden_import", {**IMPORT_BASE, **scenario_settings}, threads)


RUNS = [
    *policy_runs(),
    Run("single_light", "single_light"),
    Run("first_steps", "first_steps", {}),
    Run("first_steps_electric", "first_steps", {"vehicle": "electric_100kw"}),
    Run("first_steps_measured", "first_steps", {"measure.energy": "on", "measure.surrogate_safety": "on"}),
    Run("first_steps_measured_meso", "first_steps", {"measure.energy": "on", "measure.surrogate_safety": "on", **MESO}),
    Run("first_steps_own_laws", "first_steps", OWN_LAWS),
    Run("first_steps_own_laws_meso", "first_steps", {**OWN_LAWS, **MESO}),
    # A channel with bursts of losses, delays with jitter, and platoons with a leader. The state hash contains the
    # driving modes.
    Run("light_full_radio", "single_light",
        {**SHORT_LIGHT, "populations": "[CDG, CTG-Ref]",
         "driver.v2v": "{channel: gilbert, loss: 20 %, burst: 5, jitter: 30 ms, topology: predecessor_and_leader}"}),
    Run("grid_full_radio", "grid",
        {**SMALL_GRID, **FULL, "duration": "240 s", "measure.window": "120 s", **population("CDG"),
         "driver.v2v": "{channel: delivery_over_distance, delivery: cv2x_2_subchannels}"}),
    Run("grid_full_radio", "grid",
        {**SMALL_GRID, **FULL, "duration": "240 s", "measure.window": "120 s", **population("CDG"),
         "driver.v2v": "{channel: delivery_over_distance, delivery: cv2x_2_subchannels}"}, threads=2),
    Run("first_steps_diesel", "first_steps", {"vehicle": "diesel_eu4_103kw"}),
    Run("intersection", "intersection", {**QUICK_CYCLES, "signal.green": "10 s"}),
    Run("intersection_turns", "intersection", {**QUICK_CYCLES, "demand.left": "15 %", "demand.right": "10 %"}),
    Run("intersection_meso", "intersection", {**QUICK_CYCLES, **MESO, "demand.left": "30 %", "demand.right": "30 %"}),
    Run("intersection_meso_fitted", "intersection",
        {**QUICK_CYCLES, **MESO, "meso": "fitted", "demand.left": "5 %", "demand.right": "10 %"}),
    Run("calibration", "calibration", {"demand.vehicles": "8", "populations": "[CDG, CTG-Ref]", "step": "20 ms"}),
    Run("calibration_meso", "calibration", {"demand.vehicles": "8", **MESO}),
    Run("arterial", "arterial", SHORT_STREET),
    Run("arterial", "arterial", SHORT_STREET, threads=2),
    Run("arterial_turns_wave", "arterial",
        {**SHORT_STREET, "demand.left": "10 %", "demand.right": "20 %", "signal.offset": "15 s"}),
    Run("arterial_table2", "arterial", {**SHORT_STREET, "meso": "table2"}),
    Run("arterial_full", "arterial", {**FULL, "duration": "240 s", "measure.window": "120 s", "measure.time_space": "100 s"}),
    Run("arterial_quiet_crossings", "arterial",
        {**SHORT_STREET, "demand.cross_inflow": "200 veh/h", "signal.green": "35 s", "signal.cross_green": "5 s"}),
    Run("grid", "grid", SHORT_GRID),
    Run("grid", "grid", SHORT_GRID, threads=2),
    Run("grid_gridlock", "grid", GRIDLOCK, situation=("gridlocks", "passed_blockers")),
    Run("grid_gridlock", "grid", GRIDLOCK, threads=2),
    Run("grid_gridlock_no_keep_clear", "grid", {**GRIDLOCK, "duration": "700 s", "rules.keep_clear": "off"},
        situation=("gridlocks",)),
    Run("grid_rate", "grid", {**SHORT_GRID, "demand.kind": "rate", "demand.inflow": "600 veh/h", "demand.left": "10 %"}),
    Run("grid_sight_no_queue_at_red", "grid", {**SHORT_GRID, "rules.sight": "100 m", "rules.count_queue_at_red_exit": "off"}),
    Run("small_grid_full", "grid", {**SMALL_GRID, **FULL, "duration": "240 s", "measure.window": "120 s"}),
    Run("small_grid_full", "grid", {**SMALL_GRID, **FULL, "duration": "240 s", "measure.window": "120 s"}, threads=2),
    Run("grid_full_gridlock", "grid", {**GRIDLOCK, **FULL}, situation=("gridlocks", "passed_blockers")),
    Run("small_grid_switch", "grid",
        {**SMALL_GRID, "populations": "[SWITCH-1, SWITCH-2]", "measure.baseline": "SWITCH-1"}),
    Run("grid_mini_platoons", "coordination_grid", {**SMALL_GRID, "driver.platoon.max_vehicles": "5"}),
    Run("grid_mini_platoons", "coordination_grid", {**SMALL_GRID, "driver.platoon.max_vehicles": "5"}, threads=2),
    Run("berlin_three_lanes", "berlin", {"duration": "420 s"}),
    Run("berlin_three_lanes", "berlin", {"duration": "420 s"}, threads=2),
    Run("berlin_four_lanes", "berlin", {"duration": "300 s", "network.streets": "four_lanes"}),
    Run("berlin_pockets_gap_opening", "berlin",
        {"duration": "300 s", "network.streets": "three_lanes_pockets", "driver.lane_change.gap_opening": "on"}),
    Run("berlin_gap_agreements", "berlin",
        {"duration": "300 s", "driver.lane_change.gap_opening": "cooperative", "driver.v2v": "{channel: bernoulli, loss: 20 %}"}),
    Run("berlin_full", "berlin", {"duration": "120 s", **FULL, **population("CDG")}),
    Run("two_intersections", "berlin", TWO_STREETS),
    Run("two_intersections_full", "berlin", {**TWO_STREETS, **FULL, "duration": "300 s", **MIXED}),
    imported("import_random", {**sumo("fast_random"), "duration": "500 s", "measure.window": "400 s"}),
    imported("import_random", {**sumo("fast_random"), "duration": "500 s", "measure.window": "400 s"}, threads=2),
    imported("import_random_full", {**sumo("fast_random"), **FULL, "duration": "200 s", "measure.window": "120 s"}),
    imported("import_lights", {**sumo("lights_grid"), "duration": "500 s", "measure.window": "400 s"}),
    imported("import_lights_full", {**sumo("lights_grid"), **FULL, "duration": "200 s", "measure.window": "120 s"}),
    imported("import_wrong_turn_lane", {**sumo("wrong_turn_lane"), "duration": "400 s", "measure.window": "300 s"}),
    imported("import_roundabout", {**sumo("roundabout"), "duration": "300 s", "measure.window": "200 s"}),
    Run("morning", "morning", {"duration": "1500 s", "measure.window": "900 s"}, situation=("departure_delay_max_s",)),
    Run("morning", "morning", {"duration": "1500 s", "measure.window": "900 s"}, threads=2),
    Run("grid_matrix_full", "grid", MATRIX),
    Run("grid_matrix_full", "grid", MATRIX, threads=2),
    Run("startup", "", program="stopline-startup"),
]

IMPORT_SCENARIO = "fidelity: meso\n"  # the settings of the run give all other fields


def add_numbers(hasher, path):
    """Hashes the numeric cells of a CSV file row by row. Returns the number of these cells."""
    count = 0
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.reader(file):
            for cell in row:
                try:
                    float(cell)
                except ValueError:
                    continue
                hasher.update(cell.encode() + b";")
                count += 1
            hasher.update(b"\n")
    return count


def hashes_of(folder):
    states = hashlib.sha256()
    tables = []
    cells = 0
    for path in folder.rglob("*.provenance.json"):
        for population_name, state in json.loads(path.read_text()).get("state_hashes", {}).items():
            states.update(f"{population_name}={state};".encode())
    for path in folder.rglob("*.csv"):
        hasher = hashlib.sha256()
        cells += add_numbers(hasher, path)
        tables.append(hasher.hexdigest())
    # The hashes are sorted, so that a table can be renamed.
    return states.hexdigest()[:16], hashlib.sha256("".join(sorted(tables)).encode()).hexdigest()[:16], cells


def has_positive(path, column):
    """Returns True if a row of a CSV file has a value above 0 in the column."""
    with open(path, newline="", encoding="utf-8") as file:
        return any(float(row[column]) > 0 for row in csv.DictReader(file))


def execute(run, binaries):
    with tempfile.TemporaryDirectory() as work:
        work = Path(work)
        output = work / "out"
        command = [str(binaries / run.program)]
        if run.scenario == "golden_import":
            (work / "golden_import.yaml").write_text(IMPORT_SCENARIO)
            command.append(str(work / "golden_import.yaml"))
        elif run.scenario:
            command.append(str(SOURCE / "scenarios" / f"{run.scenario}.yaml"))
        for key, value in run.settings.items():
            command += ["--set", f"{key}={value}"]
        if run.program == "stopline-run":
            command += ["--threads", str(run.threads), "--no-figures"]
        command += ["--output", str(output)]
        environment = {**os.environ, "OMP_WAIT_POLICY": "passive"}
        result = subprocess.run(command, capture_output=True, text=True, env=environment)
        if result.returncode != 0:
            return run, None, f"exit code {result.returncode}: {result.stderr[-600:]}{result.stdout[-600:]}"
        for column in run.situation:
            if not has_positive(output / "summary.csv", column):
                return run, None, f"{column} is 0 in all rows of summary.csv, so the run does not reach its situation"
        states, tables, cells = hashes_of(output)
        if cells < 10:
            return run, None, f"the tables have only {cells} numbers, too few to compare"
        return run, (states, tables), None


def check(run, hashes, golden):
    expected = golden.get(run.name)
    if expected is None:
        return f"{run.name}: no row in {TABLE.name}"
    return "".join(
        f"{run.name} on {run.threads} thread(s): {column} {value} differs from {wanted}\n"
        for column, value, wanted in zip(HEADER[1:], hashes, expected)
        if value != wanted).rstrip()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binaries", type=Path)
    parser.add_argument("--update", action="store_true", help="rewrite golden_hashes.csv")
    parser.add_argument("--only", default="", help="run only the runs with this text in their name")
    arguments = parser.parse_args()

    golden = {}
    if TABLE.exists():
        with open(TABLE, newline="", encoding="utf-8") as file:
            golden = {row["run"]: (row["state_hash"], row["tables_hash"]) for row in csv.DictReader(file)}
    runs = [run for run in RUNS if arguments.only in run.name]
    problems = []
    new_hashes = {}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for run, hashes, problem in pool.map(lambda run: execute(run, arguments.binaries.resolve()), runs):
            if problem:
                problems.append(f"{run.name}: {problem}")
            elif arguments.update:
                if new_hashes.setdefault(run.name, hashes) != hashes:
                    problems.append(f"{run.name}: {run.threads} threads and one thread give different hashes")
            elif difference := check(run, hashes, golden):
                problems.append(difference)
    if arguments.update and not problems:
        golden = {**(golden if arguments.only else {}), **new_hashes}
        with open(TABLE, "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(HEADER)
            writer.writerows([name, *hashes] for name, hashes in golden.items())
    for problem in problems:
        print(problem)
    print(f"{len(runs)} runs, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
