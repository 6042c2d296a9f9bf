#!/usr/bin/env python3
"""Compares permissive left turns of the mesoscale mode with SUMO and with the Highway Capacity Manual (HCM).

    left_turns.py --bin FOLDER_OF_STOPLINE_PROGRAMS [--signal continuous|cycle] [--left 100]

At one intersection, vehicles always queue on the left lane from the west. The share --left of them turns left and
yields to random traffic from the east. Both programs get the same network (stopline-export), signal and car-following
parameters (Table 2 of the paper), and each draws its own random arrivals. The signal is green all the time
(continuous), or for 24 s in each cycle of 60 s (cycle). The table has the vehicles that pass the stop line of the left
lane, per hour or per cycle.

HCM: the flow in a gap of the opposing traffic is q exp(-q 4.5 s) / (1 - exp(-q 2.5 s)), where q is the opposing flow.
In each cycle it holds for the green that remains after the opposing queue has passed. Two more vehicles turn at the end
of the green.

--set and --vtype switch something off in one of the programs, such as --vtype impatience=1.

Exit codes: 0 our left turns are at least as near to HCM as SUMO's, 1 they are not, 77 SUMO is not installed.
"""

import argparse
import json
import math
import random
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import street_runs
from cross_check import find_sumo

CRITICAL_GAP_S = 4.5
FOLLOW_UP_S = 2.5
SATURATION_1PS = 1900 / 3600  # of one opposing lane
LOST_S = 2.0                  # at the start of the green
SNEAKERS = 2                  # vehicles that turn at the end of the green
RUN_S, FROM_S, STEP_S = 3660, 300, 60  # length of a run, start of the measurement, interval of the counts
TO_S = 3600
GREENS_S = {"continuous": (1200, 1, 1), "cycle": (24, 12, 9)}  # green, green of the cross street, all red
YELLOW_S = 3
ARRIVALS_VEH_H = 1900         # in our run, on a lane that always queues
QUEUE_HEADWAY_S = 1.5         # the same in SUMO's run


class Layout:
    """The lanes of the approaches, from the left."""

    def __init__(self, left_percent):
        self.left_share = left_percent / 100
        shared = left_percent < 100
        self.lanes = ["straight+left", *["straight"] * 2] if shared else ["left", *["straight"] * 3]
        self.opposing = 3  # lanes with opposing traffic
        self.queued = len(self.lanes) if shared else 1

    def counts(self, opposing_veh_h):
        """Returns the traffic file of our run."""
        per_lane = round(ARRIVALS_VEH_H * RUN_S / 3600)
        queued = per_lane * self.queued
        left = round(per_lane * self.left_share)
        opposing = round(opposing_veh_h * RUN_S / 3600)
        rows = [f"0,{RUN_S},west,{queued},{left},{queued - left},0"]
        rows += [f"0,{RUN_S},east,{opposing},0,{opposing},0"] if opposing > 0 else []
        return "\n".join(["begin,end,approach,vehicles,left,straight,right", *rows]) + "\n"


def write_scenario(folder, layout, signal, opposing_veh_h):
    """Writes our scenario. Returns its file."""
    green_s, cross_s, all_red_s = GREENS_S[signal]
    cycles = RUN_S // (green_s + cross_s + 2 * (YELLOW_S + all_red_s))
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "traffic.csv").write_text(layout.counts(opposing_veh_h))
    file = folder / "left_turns.yaml"
    file.write_text(json.dumps({
        "fidelity": "meso", "meso": "table2", "duration": f"{RUN_S} s",
        "network": {"kind": "intersection", "intersection": {
            "lanes": [{"movements": lane} for lane in layout.lanes], "approach_length": "300 m"}},
        "signal": {"first_green": "1 s", "green": f"{green_s} s", "cross_green": f"{cross_s} s",
                   "yellow": f"{YELLOW_S} s", "all_red": f"{all_red_s} s"},
        "demand": {"kind": "counts", "counts": "./traffic.csv", "arrivals": "poisson"},
        "populations": ["CTG-Ref"],
        "measure": {"baseline": "CTG-Ref", "warmup_cycles": 0} | ({"cycles": cycles} if signal == "continuous" else {}),
    }))  # fmt: skip
    return file


def settings_of(options):
    return [word for one in street_runs.LIKE_SUMO + options.set for word in ("--set", one)]


def passed(file, lane):
    """Returns the vehicles of an induction loop in the measured time."""
    return sum(int(interval.get("nVehEntered")) for interval in ElementTree.parse(file).getroot().iter("interval")
               if re.match(lane, interval.get("id")) and FROM_S <= float(interval.get("begin"))
               and float(interval.get("end")) <= TO_S)


def run_ours(options, layout, opposing_veh_h, seed, folder):
    """Returns the vehicles that pass the stop line of the left lane."""
    file = write_scenario(folder, layout, options.signal, opposing_veh_h)
    command = [options.bin / "stopline-run", file, "--no-figures", "--threads", "1", "--seed", seed, "--output",
               folder / "out", "--e1", folder / "loops.xml", "--e1-interval", f"{STEP_S} s", *settings_of(options)]
    ended = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False)
    if ended.returncode != 0:
        raise SystemExit(f"stopline-run failed:\n{(ended.stdout + ended.stderr)[-3000:]}")
    return passed(folder / "loops.xml", "west_in_0_stop_line")


def vehicle(depart_s, edges, lane):
    return (depart_s, f'type="car" depart="{depart_s:.1f}" departLane="{lane}" departPos="base" departSpeed="max">'
                      f'<route edges="{edges}"/></vehicle>')


def write_demand(file, layout, vehicle_type, opposing_veh_h, seed):
    """Writes SUMO's vehicles. On the left lane from the west they depart faster than a queue discharges."""
    rng = random.Random(f"{seed} {opposing_veh_h}")
    left_lane = len(layout.lanes) - 1
    vehicles = []
    for k in range(int(RUN_S / QUEUE_HEADWAY_S)):
        turns_left = rng.random() < layout.left_share
        vehicles.append(vehicle(k * QUEUE_HEADWAY_S, f"west_in {'north' if turns_left else 'east'}_out", left_lane))
    for lane in range(layout.opposing):
        depart_s = rng.expovariate(opposing_veh_h / layout.opposing / 3600) if opposing_veh_h > 0 else RUN_S
        while depart_s < RUN_S:
            vehicles.append(vehicle(depart_s, "east_in west_out", lane))
            depart_s += rng.expovariate(opposing_veh_h / layout.opposing / 3600)
    lines = [f'<vehicle id="{k}" {text}' for k, (_, text) in enumerate(sorted(vehicles))]
    file.write_text("\n".join(["<routes>", vehicle_type, *lines, "</routes>"]))


def vehicle_type(exported, settings):
    """Returns the exported vehicle type as XML. `settings`: attributes that replace its own, as NAME=VALUE."""
    attributes = dict(ElementTree.parse(exported / "vehicles.rou.xml").getroot().find("vType").attrib)
    attributes |= {"id": "car", **dict(setting.split("=", 1) for setting in settings)}
    return "<vType " + " ".join(f'{name}="{value}"' for name, value in attributes.items()) + "/>"


def run_sumo(options, sumo, exported, layout, opposing_veh_h, seed, folder):
    """Returns the vehicles that pass the stop line of the left lane."""
    folder.mkdir(parents=True, exist_ok=True)
    write_demand(folder / "demand.rou.xml", layout, vehicle_type(exported, options.vtype), opposing_veh_h, seed)
    (folder / "loops.add.xml").write_text(
        f'<additional><inductionLoop id="left" lane="west_in_{len(layout.lanes) - 1}" pos="-0.1" period="{STEP_S}" '
        'file="loops.xml"/></additional>')
    street_runs.check_call([sumo, "-c", exported / "run.sumocfg", "--route-files", "demand.rou.xml",
                            "--additional-files", "loops.add.xml", "--end", RUN_S, "--no-step-log", "--no-warnings",
                            "--seed", seed, "--max-depart-delay", 1.6], folder)
    return passed(folder / "loops.xml", "left")


def hcm(signal, opposing_veh_h, lanes):
    """Returns the capacity of an exclusive left lane: vehicles per second of green, or per cycle."""
    flow_1ps = opposing_veh_h / 3600
    in_gaps_1ps = (flow_1ps * math.exp(-flow_1ps * CRITICAL_GAP_S) / (1 - math.exp(-flow_1ps * FOLLOW_UP_S))
                   if flow_1ps > 0 else 1 / FOLLOW_UP_S)  # fmt: skip
    if signal == "continuous":
        return in_gaps_1ps
    green_s, cross_s, all_red_s = GREENS_S[signal]
    red_s = cross_s + 2 * (YELLOW_S + all_red_s)
    clearing_s = LOST_S + flow_1ps * (red_s + LOST_S) / (lanes * SATURATION_1PS - flow_1ps)
    return in_gaps_1ps * max(green_s - clearing_s, 0) + SNEAKERS


def compare(options, sumo, folder):
    """Prints the table. Returns the number of opposing flows where SUMO is nearer to HCM than we are."""
    layout = Layout(options.left)
    exported = folder / "export"
    file = write_scenario(folder, layout, options.signal, 600)
    street_runs.check_call([options.bin / "stopline-export", file, "--sumo", exported, *settings_of(options)])
    green_s, cross_s, all_red_s = GREENS_S[options.signal]
    cycle_s = green_s + cross_s + 2 * (YELLOW_S + all_red_s)
    per_unit = 3600 if options.signal == "continuous" else cycle_s
    print(f"left lane, {options.left} % of its vehicles turn left, vehicles per "
          f"{'hour' if options.signal == 'continuous' else f'cycle of {cycle_s} s'}")
    print("opposing veh/h      ours      SUMO" + ("       HCM" if options.left == 100 else ""))
    farther = 0
    for opposing_veh_h in options.opposing:
        means = []
        for run in (lambda seed: run_ours(options, layout, opposing_veh_h, seed, folder / "ours"),
                    lambda seed: run_sumo(options, sumo, exported, layout, opposing_veh_h, seed, folder / "sumo")):
            count = sum(run(seed) for seed in range(1, options.seeds + 1)) / options.seeds
            means.append(count * per_unit / (TO_S - FROM_S))
        line = f"{opposing_veh_h:14.0f}{means[0]:10.1f}{means[1]:10.1f}"
        if options.left == 100:
            manual = hcm(options.signal, opposing_veh_h, layout.opposing)
            manual *= 3600 if options.signal == "continuous" else 1
            line += f"{manual:10.1f}"
            farther += abs(means[0] - manual) > abs(means[1] - manual)
        print(line, flush=True)
    return farther


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=Path, required=True, help="folder of the Stopline programs")
    parser.add_argument("--signal", choices=list(GREENS_S), default="continuous", help="default: %(default)s")
    parser.add_argument("--left", type=int, default=100, help="share of left turns on the left lane, %% (default: 100)")
    parser.add_argument("--opposing", type=float, nargs="+", default=[200.0, 400.0, 600.0, 800.0, 1000.0, 1200.0],
                        help="opposing flows, veh/h, on three lanes together")
    parser.add_argument("--seeds", type=int, default=2, help="number of runs of each program (default: 2)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="setting of our scenario")
    parser.add_argument("--vtype", action="append", default=[], metavar="KEY=VALUE",
                        help="attribute of SUMO's vehicle type")
    options = parser.parse_args()
    found = find_sumo()
    if found is None:
        print("skipped: SUMO is not installed (pip install eclipse-sumo)")
        return 77
    options.bin = options.bin.resolve()
    with tempfile.TemporaryDirectory() as folder:
        farther = compare(options, found[0], Path(folder).resolve())
    if farther:
        print(f"SUMO is nearer to HCM at {farther} of {len(options.opposing)} opposing flows")
    return 1 if farther else 0


if __name__ == "__main__":
    sys.exit(main())
