"""Runs streets in stopline-run and in SUMO, and counts vehicles at the same places.

A count is a dictionary: {detector: [vehicles in each signal cycle]}. Detectors are named as in stopline-run.
"""

import csv
import hashlib
import json
import os
import re
import shutil
import subprocess
import xml.etree.ElementTree as ElementTree
from collections import defaultdict
from pathlib import Path

import street_inputs
from cross_check import HERE

POPULATIONS = {"CTG": "CTG-Ref", "dense": "CDG", "short_gap": "CTG-0.1"}
SHORT_TAU = {"tau": "0.1"}  # SUMO's step; SUMO does not allow a shorter reaction time
# Settings of our run for the policy short_gap. Our vehicles then have the parameters that SUMO's vehicles have with the
# policy dense.
SHORT_GAP = ["meso={base: table2, constant_time: {acceleration: 1.4 m/s2, reaction: 0.1 s, dawdling: 0.02}, "
             "calibrated_time_gap: 0.1 s}",
             "policies=[{name: CTG-0.1, law: constant_time, standstill_gap: 2.95 m, time_gap: 0.1 s}]"]
MARGIN_M = 20
# Makes our drivers behave like SUMO's: no hesitation at the start of green, and SUMO's deceleration at stop lines.
LIKE_SUMO = ["driver.free_drive.hesitation=0 s", "driver.stop.deceleration=4.7 m/s2",
             "driver.stop.decision_deceleration=5.3 m/s2"]
# With these values, critical_gaps.py measures nearly the same gaps and lags in both programs at one intersection.
YIELD_LIKE_SUMO = ["driver.give_way.critical_gap=11.8 s", "driver.give_way.critical_lag=8.3 s"]
PASSING_CLEARANCE = "network.streets.passing_clearance"
STREETS_FOLDER = HERE.parents[1] / "data" / "berlin"
DEFAULT_LANE_WIDTH = "3.5 m"
EXPORT_S = 300  # length of the run of stopline-export; longer than a signal cycle
KEY_S = 60      # sumo_key() hashes the demand of the first 60 s only; this part identifies the whole demand
VIOLATIONS = ["overlaps", "conflicts", "red_entries", "lost_vehicles"]


class Run:
    """The results of one run of one program."""

    def __init__(self, counts, teleported, notes=()):
        self.counts = counts
        self.teleported = teleported
        self.notes = list(notes)  # sentences about violations and other faults


def key_of(setting):
    """Returns the key of KEY=VALUE."""
    return setting.split("=", 1)[0]


def yield_settings(chosen):
    """Returns the settings with which our drivers yield like SUMO's; none if the user has chosen one of them."""
    return YIELD_LIKE_SUMO if {key_of(setting) for setting in chosen}.isdisjoint(map(key_of, YIELD_LIKE_SUMO)) else []


def lane_width(options):
    """Returns the lane width of the streets, as text with a unit."""
    texts = [options.scenario.read_text(encoding="utf-8")]
    named = re.search(r"\bstreets:\s*([^\s{},#]+)", texts[0])
    name = options.layout or (named[1] if named else "")
    for file in (Path(name), options.scenario.parent / name, STREETS_FOLDER / f"{name}.yaml"):
        if name and file.is_file():
            texts.insert(0, file.read_text(encoding="utf-8"))
            break
    widths = [found[1] for text in texts if (found := re.search(r"\blane_width:\s*([0-9.]+\s*m)\b", text))]
    return widths[0] if widths else DEFAULT_LANE_WIDTH


def settings_of(options, policy, duration_s):
    """Returns the settings of the scenario as arguments. The user's settings (options.set) may replace those that make
    our drivers behave like SUMO's. If the user sets the critical gap or the critical lag, neither of
    SUMO's values is used."""
    population = POPULATIONS[policy]
    own = ["fidelity=meso", *(SHORT_GAP if policy == "short_gap" else ["meso=table2"]),
           f"populations=[{population}]", f"measure.baseline={population}",
           "demand.kind=saturated", "demand.start=empty", f"duration={duration_s} s",
           f"measure.area_margin={MARGIN_M} m", "measure.window=1 s"]
    if options.layout:
        path = Path(options.layout)
        own.append(f"network.streets={path.resolve() if path.is_file() else options.layout}")
    if not options.own_driver:
        chosen = {key_of(setting) for setting in options.set}
        own += [setting for setting in LIKE_SUMO if key_of(setting) not in chosen]
        # SUMO's vehicles wait behind a left turner from their own lane until the paths are a lane width apart.
        own += [] if PASSING_CLEARANCE in chosen else [f"{PASSING_CLEARANCE}={lane_width(options)}"]
        own += yield_settings(options.set)
    arguments = []
    for setting in own + options.set:
        arguments += ["--set", setting]
    return arguments


def check_call(command, folder=None):
    """Runs a program. Returns its output. If the program fails, ends this script with a message."""
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


def read_inserted(file):
    """Returns the numbers of inserted vehicles by inlet lane and first turn: {"INLET.LANE": {turn: number}}."""
    inserted = defaultdict(lambda: defaultdict(int))
    for _, trip in ElementTree.iterparse(file):
        if trip.tag == "tripinfo":
            lane, _, turn = trip.get("id").rsplit(".", 2)
            inserted[lane][turn] += 1
            trip.clear()
    return inserted


def run_ours(options, policy, seed, cycle_s, folder):
    """Runs stopline-run. Returns its Run. Leaves its tables in the folder."""
    command = [options.bin / "stopline-run", options.scenario, "--no-figures", "--seed", str(seed), "--threads", "1",
               "--output", folder, "--e1", folder / "loops.xml", "--e1-interval", f"{cycle_s} s"]
    settings = settings_of(options, policy, options.duration)
    ended = subprocess.run([str(word) for word in command + settings], capture_output=True, text=True, check=False)
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
    if policy != "CTG":
        vehicle_type.update(SHORT_TAU)
    vehicle_type.update(dict(setting.split("=", 1) for setting in options.vtype))
    return "<vType " + " ".join(f'{name}="{value}"' for name, value in vehicle_type.items()) + "/>"


def sumo_key(study, seed, choices, folder):
    """Returns a hash of everything on which a run of SUMO depends, except its duration."""
    key = hashlib.sha256(" ".join([*choices, str(seed)]).encode())
    write_sumo_inputs(study, seed, KEY_S, folder)
    for file in (study.folder / "net.net.xml", study.folder / "run.sumocfg", folder / "demand.rou.xml",
                 folder / "area.add.xml"):
        text = re.sub(rb"<!--.*?-->", b"", file.read_bytes(), flags=re.DOTALL)  # comments hold the date
        key.update(re.sub(rb"<end value=.*?/>", b"", text))
    return key.hexdigest()[:24]


def write_sumo_inputs(study, seed, duration_s, folder):
    folder.mkdir(parents=True, exist_ok=True)
    street_inputs.write_demand(folder / "demand.rou.xml", study.streets, study.shares, study.vehicle_type, duration_s,
                               seed)
    street_inputs.write_detectors(folder / "area.add.xml", study.streets, study.detectors, MARGIN_M, study.cycle_s)


def run_sumo(options, sumo, seed, study, folder):
    """Runs SUMO. Returns its Run. If an earlier run with the same inputs was at least as long, its stored counts are
    used."""
    choices = ["--seed", str(seed), "--max-depart-delay", str(street_inputs.MAX_DELAY_S), *options.sumo_option]
    stored = Path(options.cache) / f"{sumo_key(study, seed, choices, folder)}.json"
    cycles = int(options.duration // study.cycle_s)
    result = json.loads(stored.read_text()) if stored.exists() else None
    if result is None or len(result["teleported"]) < cycles:
        write_sumo_inputs(study, seed, options.duration, folder)
        check_call([sumo, "-c", study.folder / "run.sumocfg", "--route-files", "demand.rou.xml", "--additional-files",
                    "area.add.xml", "--summary-output", "summary.xml", "--summary-output.period", study.cycle_s,
                    "--tripinfo-output", "trips.xml", "--tripinfo-output.write-unfinished",
                    "--end", options.duration + 1, "--no-step-log", "--no-warnings", *choices], folder)
        # The first row is for the start. The others hold sums since the start, at the end of each cycle.
        steps = list(ElementTree.parse(folder / "summary.xml").getroot().iter("step"))[1:cycles + 1]
        if len(steps) < cycles:  # SUMO ends normally after a signal
            raise SystemExit(f"SUMO, seed {seed}, ended early: {len(steps)} of {cycles} signal cycles")
        result = {"counts": {name: counts[:cycles] for name, counts in read_loops(folder / "loops.xml").items()},
                  "inserted": read_inserted(folder / "trips.xml"), "run_s": options.duration,
                  "teleported": [int(step.get("teleports")) for step in steps],
                  "collisions": [int(step.get("collisions")) for step in steps]}
        stored.parent.mkdir(parents=True, exist_ok=True)
        part = stored.with_suffix(f".{os.getpid()}.part")
        part.write_text(json.dumps(result))
        part.replace(stored)
    shutil.rmtree(folder)
    collisions = result["collisions"][cycles - 1]
    notes = [f"SUMO, seed {seed}: {collisions} collisions"] if collisions else []
    notes += [f"SUMO, seed {seed}: {fault}" for fault in street_inputs.insertion_faults(
        study.streets, study.shares, result["inserted"], result["run_s"])]
    counts = {name: by_cycle[:cycles] for name, by_cycle in result["counts"].items()}
    return Run(counts, result["teleported"][cycles - 1], notes)
