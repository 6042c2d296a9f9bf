"""Runs streets in stopline-run and in SUMO, and counts vehicles at the same places.

A count is a dictionary: {detector: [vehicles in each signal cycle]}. Detectors are named as in stopline-run.
"""

import csv
import hashlib
import json
import re
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree
from collections import defaultdict
from pathlib import Path

import street_inputs

POPULATIONS = {"CTG": "CTG-Ref", "dense": "CDG"}
DENSE = {"tau": "0.1"}  # SUMO's step; SUMO does not allow a shorter reaction time
MARGIN_M = 20
EXPORT_S = 300  # longer than a signal cycle
VIOLATIONS = ["overlaps", "conflicts", "red_entries", "lost_vehicles"]


class Run:
    """The results of one run of one program."""

    def __init__(self, counts, teleported, notes=()):
        self.counts = counts
        self.teleported = teleported
        self.notes = list(notes)  # sentences about violations and other faults


def settings_of(options, policy, duration_s):
    """Returns the settings of the scenario."""
    population = POPULATIONS[policy]
    own = ["fidelity=meso", "meso=table2", f"populations=[{population}]", f"measure.baseline={population}",
           f"duration={duration_s} s", f"measure.area_margin={MARGIN_M} m", "measure.window=1 s"]
    if options.layout:
        own.append(f"network.streets={options.layout}")
    arguments = []
    for setting in own + options.set:
        arguments += ["--set", setting]
    return arguments


def check_call(command, folder=None):
    """Runs a program. Returns its output. Ends this program if it fails."""
    ended = subprocess.run([str(word) for word in command], cwd=folder, capture_output=True, text=True, check=False)
    if ended.returncode != 0:
        raise SystemExit(f"{' '.join(str(word) for word in command)}\nfailed:\n{(ended.stdout + ended.stderr)[-3000:]}")
    return ended.stdout


def read_loops(file):
    counts = defaultdict(list)
    for _, interval in ElementTree.iterparse(file):
        if interval.tag == "interval":
            counts[interval.get("id")].append(int(interval.get("nVehEntered")))
            interval.clear()
    return dict(counts)


def run_ours(options, policy, seed, cycle_s, folder):
    """Runs stopline-run. Returns its Run. Leaves its tables in the folder."""
    command = [options.bin / "stopline-run", options.scenario, "--no-figures", "--seed", str(seed), "--threads", "1",
               "--output", folder, "--e1", folder / "loops.xml", "--e1-interval", f"{cycle_s} s"]
    ended = subprocess.run([str(word) for word in command + settings_of(options, policy, options.duration)],
                           capture_output=True, text=True, check=False)
    if ended.returncode not in (0, 1):  # 1: violations, which the tables count
        raise SystemExit(f"{command[0]} failed:\n{(ended.stdout + ended.stderr)[-3000:]}")
    with open(folder / "summary.csv", newline="", encoding="utf-8") as file:
        summary = next(csv.DictReader(file))
    notes = [f"ours, seed {seed}: {summary[name]} {name}" for name in VIOLATIONS if int(summary[name]) > 0]
    return Run(read_loops(folder / "loops.xml"), int(summary["teleported"]), notes)


def export(options, policy, folder):
    """Writes the network of the scenario for SUMO. Returns the vehicle type of the policy, as attributes."""
    check_call([options.bin / "stopline-export", options.scenario, "--sumo", folder, "--population",
                POPULATIONS[policy], *settings_of(options, policy, EXPORT_S)])
    vehicle_type = ElementTree.parse(folder / "vehicles.rou.xml").getroot().find("vType").attrib
    vehicle_type["id"] = "car"
    if policy == "dense":
        vehicle_type.update(DENSE)
    vehicle_type.update(dict(setting.split("=", 1) for setting in options.vtype))
    return "<vType " + " ".join(f'{name}="{value}"' for name, value in vehicle_type.items()) + "/>"


def run_sumo(options, sumo, seed, study, folder):
    """Runs SUMO. Returns its Run. If an earlier run had the same inputs, its stored result is returned."""
    folder.mkdir(parents=True, exist_ok=True)
    street_inputs.write_demand(folder / "demand.rou.xml", study.streets, study.shares, study.vehicle_type,
                               options.duration, seed)
    street_inputs.write_detectors(folder / "area.add.xml", study.streets, study.detectors, MARGIN_M, study.cycle_s)
    choices = ["--end", str(options.duration), "--seed", str(seed), "--max-depart-delay",
               str(street_inputs.MAX_DELAY_S), "--no-step-log", "--no-warnings", *options.sumo_option]
    key = hashlib.sha256(" ".join(choices).encode())
    for file in (study.folder / "net.net.xml", study.folder / "run.sumocfg", folder / "demand.rou.xml",
                 folder / "area.add.xml"):
        key.update(re.sub(rb"<!--.*?-->", b"", file.read_bytes(), flags=re.DOTALL))  # comments hold the date
    stored = Path(options.cache) / f"{key.hexdigest()[:24]}.json"
    if not stored.exists():
        check_call([sumo, "-c", study.folder / "run.sumocfg", "--route-files", "demand.rou.xml", "--additional-files",
                    "area.add.xml", "--statistic-output", "statistics.xml", *choices], folder)
        statistics = ElementTree.parse(folder / "statistics.xml").getroot()
        result = {"counts": read_loops(folder / "loops.xml"),
                  "teleported": int(statistics.find("teleports").get("total")),
                  "collisions": int(statistics.find("safety").get("collisions"))}
        stored.parent.mkdir(parents=True, exist_ok=True)
        part = stored.with_suffix(f".{seed}.part")
        part.write_text(json.dumps(result))
        part.replace(stored)
    result = json.loads(stored.read_text())
    shutil.rmtree(folder)
    notes = [f"SUMO, seed {seed}: {result['collisions']} collisions"] if result["collisions"] else []
    return Run(result["counts"], result["teleported"], notes)
