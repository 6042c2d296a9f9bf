#!/usr/bin/env python3
"""Runs random scenarios and checks each run. Makes scenarios that fail smaller.

    simulations.py BIN [--runs 1000] [--seed 1] [--output campaign] [--jobs 1]

BIN is the folder of the programs, such as build/release/bin. A scenario has a number, which is the seed of its random
features (scenarios.py). The first number is --seed. stopline_check_scenario runs the scenario and checks the run; the
source of this program lists the checks (check_scenario.cpp). A scenario that the program refuses is no failure, but a
crash is one, and so is a run of more than 120 s.

For each failure, the folder --output gets a smaller scenario that fails in the same way, with all files that it needs.
The command to repeat the failure is printed. Exit codes: 0 no run failed, 1 some runs failed.
"""

import argparse
import collections
import json
import random
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import scenarios
import shrink

LONGEST_S = 120
# Lines of stopline_check_scenario that are no failure.
NOTES = {"refused", "starved", "compared", "rounding", "deadlock_expected"}


def write_case(case, folder):
    """Writes the files of a case. Returns the scenario file."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in case["files"].items():
        (folder / name).write_text(text)
    file = folder / "scenario.yaml"
    lines = [f"{key}: {json.dumps(value)}" for key, value in case["scenario"].items()]
    file.write_text("\n".join(lines) + "\n")
    return file


def check(binary, case, folder, words):
    """Runs a case. Returns the lines of the program as pairs (check, text)."""
    command = [str(binary / "stopline_check_scenario"), str(write_case(case, folder)), *words]
    try:
        result = subprocess.run(command, capture_output=True, text=True, errors="replace", timeout=LONGEST_S,
                                check=False)  # fmt: skip
    except subprocess.TimeoutExpired:
        return [("timeout", f"more than {LONGEST_S} s")]
    lines = [tuple(line.split("\t", 1)) for line in result.stdout.splitlines() if "\t" in line]
    if result.returncode not in (0, 1, 2):
        return [("crash", f"exit code {result.returncode}: {result.stderr.strip()[-300:]}")]
    if result.returncode == 1 and all(name in NOTES for name, _ in lines):
        return [("crash", f"exit code 1 without a failed check: {result.stderr.strip()[-300:]}")]
    return lines


def failures(lines):
    return [line for line in lines if line[0] not in NOTES]


class Campaign:
    def __init__(self, options, temporary):
        self.options = options
        self.temporary = temporary
        self.counts = collections.Counter()
        self.failed = []

    def run(self, number):
        """Runs the scenario with a number. Returns the number, the case, its extra checks and the printed lines."""
        draw = scenarios.ScenarioDraw(number)
        scenario = draw.scenario()
        case = {"scenario": scenario, "files": draw.files}
        rng = random.Random(f"words {number}")
        words = [word for word, percent in (("reference", 60), ("threads", 10)) if rng.random() * 100 < percent]
        folder = self.temporary / f"case_{number}"
        return number, case, words, check(self.options.bin, case, folder, words)

    def record(self, number, case, words, lines):
        kind = case["scenario"]["network"]["kind"]
        fidelity = case["scenario"]["fidelity"]
        refused = any(name == "refused" for name, _ in lines)
        self.counts[(kind, fidelity, "refused" if refused else "run")] += 1
        for name in {name for name, _ in lines} - {"refused"}:
            self.counts[(kind, fidelity, name)] += 1
        if failures(lines):
            self.failed.append(number)
            self.explain(number, case, words, failures(lines)[0])

    def explain(self, number, case, words, failure):
        """Makes a case smaller and prints it."""
        name, text = failure
        print(f"scenario {number}: {name}: {text}", flush=True)
        words = [word for word in words if word == name]
        folder = self.options.output / f"{name}_{number}"
        if self.options.shrink > 0:
            def still_fails(smaller):
                return any(one == name for one, _ in check(self.options.bin, smaller, folder, words))

            case = shrink.shrunk(case, still_fails, self.options.shrink)
        lines = check(self.options.bin, case, folder, words)
        print(f"  smaller: {next((text for one, text in lines if one == name), 'not repeated')}")
        print("  " + (folder / "scenario.yaml").read_text().replace("\n", "\n  ").rstrip())
        command = ["stopline_check_scenario", str(folder / "scenario.yaml"), *words]
        print(f"  to repeat it: {' '.join(command)}", flush=True)

    def table(self):
        """Returns the counts as text: one line for each kind of network and fidelity."""
        names = sorted({name for _, _, name in self.counts}, key=lambda name: (name not in ("run", "refused"), name))
        rows = [["network", "fidelity", *names]]
        for kind, fidelity in sorted({key[:2] for key in self.counts}):
            rows.append([kind, fidelity, *(str(self.counts[(kind, fidelity, name)]) for name in names)])
        rows.append(["all", "", *(str(sum(n for key, n in self.counts.items() if key[2] == name)) for name in names)])
        widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
        return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("bin", metavar="BIN", type=Path, help="folder of the programs")
    parser.add_argument("--runs", type=int, default=1000, help="number of scenarios (default: 1000)")
    parser.add_argument("--seed", type=int, default=1, help="number of the first scenario (default: 1)")
    parser.add_argument("--jobs", type=int, default=1, help="runs at the same time (default: 1)")
    parser.add_argument("--output", type=Path, default=Path("campaign"), help="folder for scenarios that fail")
    parser.add_argument("--shrink", type=int, default=300, metavar="RUNS",
                        help="runs to make a failing scenario smaller (default: 300; 0: none)")  # fmt: skip
    options = parser.parse_args()
    options.bin, options.output = options.bin.resolve(), options.output.resolve()
    begin = time.monotonic()
    with tempfile.TemporaryDirectory() as temporary, ThreadPoolExecutor(options.jobs) as pool:
        campaign = Campaign(options, Path(temporary))
        numbers = range(options.seed, options.seed + options.runs)
        for done, result in enumerate(pool.map(campaign.run, numbers), 1):
            campaign.record(*result)
            if done % 100 == 0:
                print(f"{done} of {options.runs} scenarios, {len(campaign.failed)} failed", flush=True)
    print(campaign.table())
    seconds = time.monotonic() - begin
    print(f"{options.runs} scenarios in {seconds:.0f} s, {len(campaign.failed)} failed: {campaign.failed}")
    return 1 if campaign.failed else 0


if __name__ == "__main__":
    sys.exit(main())
