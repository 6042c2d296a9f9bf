#!/usr/bin/env python3
"""Measures the critical gap and the critical lag of permissive left turns in the mesoscale mode and in SUMO.

    critical_gaps.py --bin FOLDER_OF_STOPLINE_PROGRAMS [--left 25]

The intersection is that of left_turns.py with continuous green. An opposing vehicle counts as arrived when its front is
in the middle of the intersection, 20 m beyond its stop line. A left turner counts as arrived when its front is 6 m
beyond its stop line, shortly before its waiting position.

Gap: the time between two opposing vehicles, offered to a stopped left turner.
Lag: the time from the arrival of a left turner until that of the next opposing vehicle. A left turner that does not
stop has accepted its lag, one that stops has rejected it. Lags are left out if they begin less than 5 s after an
opposing vehicle has passed the middle.

The critical value is that of Raff: the number of accepted times below it equals the number of rejected times above it.
Our drivers start, stop and yield with the settings of corridor.py. --set and --vtype change one of the programs.

Exit codes: 0 done, 77 SUMO is not installed.
"""

import argparse
import bisect
import re
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import left_turns
import street_runs
from cross_check import find_sumo

STOPPED_MPS = 0.1
ARRIVAL_M = 6.0   # distance beyond the stop line
STARTED_M = 0.3   # a stopped left turner has departed after this distance
MIDDLE_M = 20.0   # distance from the stop line to the middle of the intersection
CLEARING_S = 5.0  # an opposing vehicle has left the intersection this time after it passed the middle


class Times:
    """Accepted and rejected gaps or lags, s."""

    def __init__(self):
        self.accepted, self.rejected = [], []

    def critical_s(self):
        """Returns the critical value by the method of Raff."""
        accepted, rejected = sorted(self.accepted), sorted(self.rejected)

        def surplus(time_s):
            return bisect.bisect_left(accepted, time_s) - (len(rejected) - bisect.bisect_right(rejected, time_s))

        return next(time_s for time_s in sorted(accepted + rejected) if surplus(time_s) >= 0)

    def line(self):
        if not self.accepted or not self.rejected:
            return f"{'-':>8}{len(self.accepted):10}{'-':>16}{len(self.rejected):10}{'-':>16}"
        return (f"{self.critical_s():8.1f}{len(self.accepted):10}{min(self.accepted):16.1f}{len(self.rejected):10}"
                f"{max(self.rejected):16.1f}")


class Turner:
    """A left turner: times of its arrival, its first stop and its departure, s. None if it did not happen."""

    def __init__(self, track):
        self.arrived_s = next((t for t, position_m, _ in track if position_m >= ARRIVAL_M), None)
        stops = [(t, position_m) for t, position_m, speed_mps in track if speed_mps < STOPPED_MPS]
        self.stopped_s = stops[0][0] if stops else None
        from_m = stops[-1][1] + STARTED_M if stops else ARRIVAL_M
        self.departed_s = next((t for t, position_m, _ in track if position_m >= from_m), None)


class Run:
    """The left turners of one run, and the times at which opposing vehicles arrive."""

    def __init__(self, fcd, starts_m, opposing):
        """`starts_m`: {lane of the left turn: position of its start}. `opposing`: name pattern of the other lanes."""
        tracks, positions_m, passed_s, time_s = {}, {}, [], 0.0
        for event, element in ElementTree.iterparse(fcd, events=("start", "end")):
            if event == "start" and element.tag == "timestep":
                time_s = float(element.get("time"))
            elif event == "end" and element.tag == "vehicle":
                vehicle, lane, position_m = element.get("id"), element.get("lane"), float(element.get("pos"))
                if lane in starts_m:
                    tracks.setdefault(vehicle, []).append((time_s, starts_m[lane] + position_m,
                                                           float(element.get("speed"))))
                elif re.fullmatch(opposing, lane):
                    if positions_m.get(vehicle, 0) < MIDDLE_M <= position_m:
                        passed_s.append(time_s)
                    positions_m[vehicle] = position_m
            elif event == "end" and element.tag == "timestep":
                element.clear()
        self.turners, self.passed_s = [Turner(track) for track in tracks.values()], passed_s


def run_ours(options, layout, opposing_veh_h, seed, folder):
    file = left_turns.write_scenario(folder, layout, options.signal, opposing_veh_h)
    street_runs.check_call([options.bin / "stopline-run", file, "--no-figures", "--threads", 1, "--seed", seed,
                            "--output", folder / "out", "--fcd", folder / "fcd.xml", "--record-interval", "0.1 s",
                            *left_turns.settings_of(options)])
    return Run(folder / "fcd.xml", {":west_0_left_0": 0.0}, r":east_\d_straight_0")


def run_sumo(options, sumo, exported, layout, opposing_veh_h, seed, folder):
    net = ElementTree.parse(exported / "net.net.xml").getroot()

    def via(start, end):
        return next(c.get("via") for c in net.iter("connection") if c.get("from") == start and c.get("to") == end)

    first = via("west_in", "north_out")
    length_m = next(float(lane.get("length")) for lane in net.iter("lane") if lane.get("id") == first)
    vehicle_type = left_turns.vehicle_type(exported, options.vtype)
    left_turns.write_demand(folder / "demand.rou.xml", layout, vehicle_type, opposing_veh_h, seed)
    street_runs.check_call([sumo, "-c", exported / "run.sumocfg", "--route-files", "demand.rou.xml", "--end",
                            left_turns.RUN_S, "--no-step-log", "--no-warnings", "--seed", seed, "--max-depart-delay",
                            1.6, "--fcd-output", "fcd.xml", "--fcd-output.attributes", "id,lane,pos,speed"], folder)
    opposing = via("east_in", "west_out").rsplit("_", 1)[0] + r"_\d"
    return Run(folder / "fcd.xml", {first: 0.0, via(first.rsplit("_", 1)[0], "north_out"): length_m}, opposing)


def add_times(turner, passed_s, gaps, lags):
    """Adds the gaps and the lag of one left turner. `passed_s`: times of the opposing vehicles."""
    if turner.departed_s is None or turner.arrived_s is None:
        return
    begin = bisect.bisect(passed_s, turner.arrived_s)  # the first opposing vehicle after the arrival
    end = bisect.bisect(passed_s, turner.departed_s)   # the first one after the departure
    if begin == 0 or end == len(passed_s):
        return
    if turner.arrived_s - passed_s[begin - 1] > CLEARING_S:
        kind = lags.accepted if turner.stopped_s is None else lags.rejected
        kind.append(passed_s[begin] - turner.arrived_s)
    if turner.stopped_s is None or end == begin:
        return  # it departed before the first opposing vehicle, so no gap was offered
    gaps.rejected += [passed_s[k] - passed_s[k - 1] for k in range(begin + 1, end)]
    gaps.accepted.append(passed_s[end] - passed_s[end - 1])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--bin", type=Path, required=True, help="folder of the Stopline programs")
    parser.add_argument("--left", type=int, default=25, help="share of left turns on the left lane, %% (default: 25)")
    parser.add_argument("--opposing", type=float, nargs="+", default=[400.0, 600.0],
                        help="opposing flows, veh/h, on three lanes together")
    parser.add_argument("--seeds", type=int, default=3, help="number of runs for each flow (default: 3)")
    parser.add_argument("--set", action="append", default=[], metavar="KEY=VALUE", help="setting of our scenario")
    parser.add_argument("--vtype", action="append", default=[], metavar="KEY=VALUE",
                        help="attribute of SUMO's vehicle type, such as impatience=1")
    options = parser.parse_args()
    found = find_sumo()
    if found is None:
        print("skipped: SUMO is not installed (pip install eclipse-sumo)")
        return 77
    options.bin, options.signal = options.bin.resolve(), "continuous"
    options.set = street_runs.yield_settings(options.set) + ["measure.starvation=3600 s"] + options.set
    layout = left_turns.Layout(options.left)
    times = {program: (Times(), Times()) for program in ("ours", "SUMO")}
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary).resolve()
        exported = folder / "export"
        file = left_turns.write_scenario(folder, layout, options.signal, 600)
        street_runs.check_call([options.bin / "stopline-export", file, "--sumo", exported,
                                *left_turns.settings_of(options)])
        for opposing_veh_h in options.opposing:
            for seed in range(1, options.seeds + 1):
                runs = {"ours": run_ours(options, layout, opposing_veh_h, seed, folder),
                        "SUMO": run_sumo(options, found[0], exported, layout, opposing_veh_h, seed, folder)}
                for program, run in runs.items():
                    for turner in run.turners:
                        add_times(turner, run.passed_s, *times[program])
    print("s            critical  accepted  shortest of them  rejected  longest of them")
    for k, kind in enumerate(("gaps", "lags")):
        for program, both in times.items():
            print(f"{kind} {program:8}{both[k].line()}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
