#!/usr/bin/env python3
"""Checks the output of stopline-run for SUMO's tools: --fcd, --tripinfo, --e1.

    tables.py STOPLINE_RUN

All three files must be well-formed and agree with the result tables of the run. If SUMO is installed (pip install
eclipse-sumo lxml), they must also be valid by its schemas and readable by its tools. Exit codes: 0 all checks pass, 1 a
check fails, 77 the checks without SUMO pass and SUMO is not installed.
"""

import csv
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from collections import defaultdict
from pathlib import Path

SCENARIO = Path(__file__).resolve().parents[2] / "scenarios" / "grid.yaml"
SETTINGS = ["populations=[CDG]", "measure.baseline=CDG", "network.grid.columns=2", "network.grid.rows=2", "duration=230 s",
            "measure.window=60 s"]
FILES = {"fcd": "fcd_file.xsd", "tripinfo": "tripinfo_file.xsd", "e1": "det_e1_file.xsd"}


def check(condition, message):
    if not condition:
        sys.exit(f"FAILED: {message}")


def run(program, folder):
    command = [program, str(SCENARIO), "--no-figures", "--threads", "1", "--output", str(folder), "--trajectories",
               "--interval", "1 s", "--record-interval", "1 s", "--e1-interval", "70 s"]
    for setting in SETTINGS:
        command += ["--set", setting]
    for name in FILES:
        command += [f"--{name}", str(folder / f"{name}.xml")]
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def check_fcd(fcd, folder):
    """Compares the floating car data with trajectories.csv."""
    with open(folder / "trajectories.csv", newline="") as file:
        rows = {(float(row["time_s"]), row["vehicle"]): row for row in csv.DictReader(file)}
    count = 0
    for step in fcd:
        for vehicle in step:
            row = rows.get((float(step.get("time")), vehicle.get("id")))
            check(row is not None, f"{vehicle.attrib} is not in trajectories.csv")
            check(vehicle.get("type") == row["policy"], f"{vehicle.attrib} instead of {row}")
            check(vehicle.get("lane").strip(":").startswith(row["lane"]), f"{vehicle.attrib} instead of {row}")
            for key, column in (("x", "x_m"), ("y", "y_m"), ("speed", "speed_mps"), ("pos", "position_m")):
                check(abs(float(vehicle.get(key)) - float(row[column])) < 0.0062, f"{key}: {vehicle.attrib} instead of {row}")
            count += 1
    check(count == len(rows) > 10000, f"{count} rows instead of {len(rows)}")


def check_trips(trips, folder):
    """Compares the trips with summary.csv and checks their times and lengths."""
    with open(folder / "summary.csv", newline="") as file:
        summary = next(csv.DictReader(file))
    teleported = int(summary["teleported"])
    check(len(trips) == int(summary["exited"]) > 100, f"{len(trips)} trips, {summary['exited']} vehicles exited")
    for trip in trips:
        value = {key: float(trip.get(key)) for key in ("depart", "arrival", "duration", "routeLength", "waitingTime", "timeLoss")}
        check(abs(value["arrival"] - value["depart"] - value["duration"]) < 0.011, f"times of {trip.attrib}")
        check(value["waitingTime"] <= value["timeLoss"] + 0.05 <= value["duration"] + 0.05, f"delays of {trip.attrib}")
        # A trip leads over one to four intersections.
        check(teleported or 200 < value["routeLength"] < 1500, f"length of {trip.attrib}")


def check_loops(loops, fcd):
    """Compares the counts at each stop line with the number of vehicles that the floating car data show beyond it."""
    counted = defaultdict(int)
    for interval in loops:
        counted[interval.get("id")] += int(interval.get("nVehContrib"))
        check(0.0 <= float(interval.get("occupancy")) <= 100.0, f"occupancy of {interval.attrib}")
        passed, speed = int(interval.get("nVehContrib")), float(interval.get("speed"))
        check((passed == 0) == (speed < 0) and speed < 20, f"speed of {interval.attrib}")
        harmonic = float(interval.get("harmonicMeanSpeed"))
        check(harmonic <= speed + 0.011, f"harmonic mean of {interval.attrib}")
    last = {interval.get("id"): float(interval.get("end")) for interval in loops}
    check(set(last.values()) == {230.0}, f"the last intervals end at {set(last.values())}")
    vehicles_past = defaultdict(set)
    for step in fcd:
        for vehicle in step:
            lane = vehicle.get("lane")
            if lane.startswith(":"):
                node, leg, number = lane[1:].split("_")[:3]
                vehicles_past[f"{node}_{leg}_in_{number}_stop_line"].add(vehicle.get("id"))
    lines = {name: count for name, count in counted.items() if name.endswith("_stop_line")}
    check(len(lines) == 32, f"{len(lines)} stop lines")
    for name, count in lines.items():
        check(abs(count - len(vehicles_past[name])) <= 2, f"{name}: {count} counted, {len(vehicles_past[name])} in the floating car data")
    check(sum(lines.values()) > 300, f"too few passages: {lines}")


def sumo_home():
    try:
        import sumo
        return Path(sumo.SUMO_HOME)
    except ImportError:
        return Path(os.environ["SUMO_HOME"]) if "SUMO_HOME" in os.environ else None


def tool(home, name, *arguments):
    result = subprocess.run([sys.executable, str(home / "tools" / name), *map(str, arguments)], capture_output=True, text=True,
                            check=False, env={**os.environ, "SUMO_HOME": str(home)})
    check(result.returncode == 0, f"{name}: {result.stderr[-500:]}")
    return result.stdout


def check_with_sumo(home, folder, trees):
    from lxml import etree
    for name, schema in FILES.items():
        validator = etree.XMLSchema(etree.parse(str(home / "data" / "xsd" / schema)))
        check(validator.validate(etree.parse(str(folder / f"{name}.xml"))), f"{name}: {validator.error_log}")
        tool(home, "xml/xml2csv.py", folder / f"{name}.xml", "-o", folder / f"{name}.csv")
        with open(folder / f"{name}.csv", newline="") as file:
            rows = list(csv.DictReader(file, delimiter=";"))
        expected = sum(len(step) or 1 for step in trees[name]) if name == "fcd" else len(trees[name])
        check(len(rows) == expected, f"{name}: SUMO's tool reads {len(rows)} rows instead of {expected}")
    print(tool(home, "output/attributeStats.py", folder / "tripinfo.xml", "-a", "duration,timeLoss").strip())
    try:
        import matplotlib
        tool(home, "plot_trajectories.py", folder / "fcd.xml", "-t", "ds", "-o", folder / "plot.png", "--blind")
        check((folder / "plot.png").stat().st_size > 1000, f"the plot is empty, with matplotlib {matplotlib.__version__}")
    except ImportError:
        print("matplotlib is not installed: the plot of SUMO's tool is not checked")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run(sys.argv[1], folder)
        trees = {name: ElementTree.parse(folder / f"{name}.xml").getroot() for name in FILES}
        check_fcd(trees["fcd"], folder)
        check_trips(trees["tripinfo"], folder)
        check_loops(trees["e1"], trees["fcd"])
        print("the three files agree with the result tables")
        home = sumo_home()
        try:
            if not home:
                raise ImportError("sumo")
            check_with_sumo(home, folder, trees)
        except ImportError as missing:
            print(f"the checks with SUMO are skipped (pip install eclipse-sumo lxml): {missing}")
            return 77
        print("the files are valid by SUMO's schemas and readable by its tools")
    return 0


if __name__ == "__main__":
    sys.exit(main())
