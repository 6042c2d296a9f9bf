#!/usr/bin/env python3
"""Compares the mesoscale mode with SUMO on streets, where all inlets are saturated.

    corridor.py --bin FOLDER_OF_STOPLINE_PROGRAMS

Both programs get the same network (stopline-export), signals and car-following parameters (Table 2 of the paper). Our
drivers start, stop and yield like SUMO's, and wait like SUMO's behind left turners. SUMO's demand does not come from
our run: vehicles always wait on each inlet lane, and their turns are drawn at random with the shares of the streets
file. Both programs count vehicles at the same places. SUMO's results are stored, so that a second comparison with the
same inputs is fast.

Exit codes: 0 all requirements are met, 1 some are missed, 77 SUMO is not installed.
"""

import argparse
import csv
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import street_inputs
import street_runs
import street_tables
from cross_check import HERE, find_sumo

LAYOUTS = ["three_lanes", "four_lanes", "three_lanes_pockets", "four_lanes_pockets"]
LIMIT_PERCENT = 5.0
LIMIT_LANE = 1.5  # vehicles in a signal cycle


class Study:
    """The inputs that all runs of one layout and policy share."""

    def __init__(self, options, policy, folder):
        self.folder = folder / "inputs"
        self.vehicle_type = street_runs.export(options, policy, self.folder)
        self.streets = street_inputs.Streets(self.folder)
        self.cycle_s = self.streets.cycle_s(self.folder)
        self.shares = {}
        self.detectors = []


def compare(options, name, policy, sumo, folder):
    """Runs both programs with all seeds. Returns the Comparison."""
    study = Study(options, policy, folder)
    seeds = range(1, options.seeds + 1)
    with ThreadPoolExecutor(options.jobs) as pool:
        ours = list(pool.map(lambda seed: street_runs.run_ours(options, policy, seed, study.cycle_s,
                                                               folder / f"ours_{seed}"), seeds))
        study.shares = street_inputs.read_turn_shares(folder / "ours_1" / "turns.csv")
        study.detectors = sorted(ours[0].counts)
        theirs = list(pool.map(lambda seed: street_runs.run_sumo(options, sumo, seed, study, folder / f"sumo_{seed}"),
                               seeds))
    first = int(options.warm_up // study.cycle_s)
    return street_tables.Comparison(name, street_tables.Totals(ours, first, study.cycle_s),
                                    street_tables.Totals(theirs, first, study.cycle_s))


def add_run_options(parser):
    parser.add_argument("--bin", type=Path, required=True, help="folder of the Stopline programs")
    parser.add_argument("--policy", action="append", choices=list(street_runs.POPULATIONS),
                        help="CTG: a time gap of 0.9 s; dense: CDG here, a time gap of 0.1 s in SUMO; short_gap: a "
                        "time gap of 0.1 s in both programs")
    parser.add_argument("--seeds", type=int, default=3, help="number of runs of each program (default: 3)")
    parser.add_argument("--duration", type=int, default=3600, help="length of a run, s (default: 3600)")
    parser.add_argument("--warm-up", type=float, default=480, help="start of the measured window, s (default: 480)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="setting of our scenario")
    parser.add_argument("--own-driver", action="store_true", help="keep the driver of the scenario. By default our "
                        "drivers start, stop and yield like SUMO's (no hesitation, deceleration 4.7 m/s2, critical gap "
                        "11.8 s, critical lag 8.3 s) and wait like SUMO's behind left turners (passing clearance: "
                        "lane width)")
    parser.add_argument("--sumo-option", action="append", default=[], metavar="OPTION", help="option of SUMO, such as "
                        "--sumo-option=--lanechange.duration=3")
    parser.add_argument("--vtype", action="append", default=[], metavar="KEY=VALUE",
                        help="attribute of SUMO's vehicle type, such as lcCooperative=0")
    parser.add_argument("--jobs", type=int, default=2, help="runs at the same time (default: 2)")
    parser.add_argument("--output", type=Path, help="folder for tables (default: out/corridor)")
    parser.add_argument("--cache", type=Path, default=Path(tempfile.gettempdir()) / "stopline_sumo_streets",
                        help="folder for SUMO's results (default: %(default)s)")


def table_of(options, name, policy, sumo):
    """Runs both programs in a temporary folder. Returns the Comparison."""
    with tempfile.TemporaryDirectory() as folder:
        return compare(options, name, policy, sumo, Path(folder).resolve())


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scenario", nargs="?", type=Path, default=HERE.parents[1] / "scenarios" / "berlin.yaml",
                        help="scenario with a network of the kind 'streets' (default: scenarios/berlin.yaml)")
    parser.add_argument("--layout", action="append", help="value of network.streets: a name in data/berlin or a path. "
                        "Default: for scenarios/berlin.yaml all four layouts, else that of the scenario")
    add_run_options(parser)
    options = parser.parse_args()
    found = find_sumo()
    if found is None:
        print("skipped: SUMO is not installed (pip install eclipse-sumo)")
        return 77
    options.bin = options.bin.resolve()
    output = options.output or Path("out/corridor")
    output.mkdir(parents=True, exist_ok=True)
    layouts = options.layout or (LAYOUTS if options.scenario.name == "berlin.yaml" else [""])
    rows, short, missed = [], [], 0
    for layout in layouts:
        for policy in options.policy or list(street_runs.POPULATIONS):
            options.layout = layout
            result = table_of(options, f"{Path(layout or options.scenario).stem}, {policy}", policy, found[0])
            faults = result.faults(LIMIT_PERCENT, LIMIT_LANE)
            missed += len(faults)
            text = result.text() + "".join(f"MISSED: {fault}\n" for fault in faults)
            print(text, flush=True)
            (output / f"{result.name.replace(', ', '_')}.txt").write_text(text)
            rows += result.csv_rows()
            short.append(result.short_line())
    print("\n".join([street_tables.SHORT_HEADING, *short]))
    with open(output / "comparison.csv", "w", newline="", encoding="utf-8") as file:
        csv.writer(file).writerows([("comparison", "quantity", "lane", "ours", "sumo"), *rows])
    print(f"Written to {output}")
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main())
