#!/usr/bin/env python3
"""Compares fixed-time, actuated and NEMA signals with SUMO at one intersection, with four demands.

    signals.py FOLDER_OF_STOPLINE_PROGRAMS [FOLDER_OF_THE_PYTHON_PACKAGE] [--seeds N] [--only NAME]

Both programs simulate the same network with the same vehicles. The table shows throughput, mean delay and mean green.
Delay is the travel time minus the fastest one of the same turn, in the same program. On yellow, the drivers of both
programs stop if their maximum deceleration suffices, as is usual in SUMO. Limits: 5 %, 10 % and 1 s. The exit code
is 1 if a difference exceeds its limit, and 77 if SUMO or the Python package is missing.
"""

import argparse
import os
import random
import statistics
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from collections import defaultdict
from pathlib import Path

from import_nets import sumo_home

ARMS = "NWSE"  # counterclockwise
DEMANDS_VEH_H = (300, 450, 600, 700)  # vehicles an hour and approach; the capacity is about 780
SHARES = {"right": 0.15, "straight": 0.65, "left": 0.2}
DURATION_S, WARM_UP_S = 3600, 300
SPEED_MPS = 13.89
SCENARIO = """
fidelity: meso
duration: {duration} s
meso: table2
driver: {{base: startup_kit, stop: {{decision_deceleration: 4.7 m/s2}}}}  # the deceleration of table2
network: {{kind: sumo, net: ./signals.net.xml, routes: [./trips.xml]}}
populations: [CTG-Ref]
measure: {{baseline: CTG-Ref, window: {window} s}}
"""
PHASES = {  # straight, left (both protected) for N and S, then E and W. Links: r, s, l from N, E, S, W
    "static": [("GGrrrrGGrrrr", 26), ("rrGrrrrrGrrr", 9), ("rrrGGrrrrGGr", 26), ("rrrrrGrrrrrG", 9)],
}
PHASES["actuated"] = PHASES["static"]
NEMA = {  # number: state, maximum
    1: ("rrrrrrrrGrrr", 12), 2: ("GGrrrrrrrrrr", 30), 3: ("rrrrrrrrrrrG", 12), 4: ("rrrGGrrrrrrr", 30),
    5: ("rrGrrrrrrrrr", 12), 6: ("rrrrrrGGrrrr", 30), 7: ("rrrrrGrrrrrr", 12), 8: ("rrrrrrrrrGGr", 30),
}
MIN_GREEN_S, YELLOW_S, RED_S = 5, 3, 1
CONTROLLERS = ("static", "actuated", "NEMA", "coordinated NEMA")
LIMITS = {"throughput": 5.0, "delay": 10.0, "green": 1.0}  # percent, percent, s


def programme(kind):
    """Returns the tlLogic of a controller."""
    if kind in PHASES:
        lines = []
        for state, green in PHASES[kind]:
            limits = f' minDur="{MIN_GREEN_S}" maxDur="{green}"' if kind == "actuated" else ""
            lines.append(f'<phase duration="{green}" state="{state}"{limits}/>')
            lines.append(f'<phase duration="{YELLOW_S}" state="{state.replace("G", "y")}"/>')
            lines.append(f'<phase duration="{RED_S}" state="{"r" * 12}"/>')
        return f'<tlLogic id="J" type="{kind}" programID="0" offset="0">{"".join(lines)}</tlLogic>'
    cycle = sum(NEMA[number][1] + YELLOW_S + RED_S for number in (1, 2, 3, 4))
    parameters = {"ring1": "3,4,1,2", "ring2": "7,8,5,6", "barrierPhases": "4,8", "coordinatePhases": "2,6",
                  "detector-length": "20", "detector-length-leftTurnLane": "20", "total-cycle-length": cycle,
                  "coordinate-mode": "true" if kind.startswith("coordinated") else "false"}  # fmt: skip
    if kind.startswith("coordinated"):
        parameters["minRecall"] = "2,6"
    lines = [f'<param key="{key}" value="{value}"/>' for key, value in parameters.items()]
    lines += [f'<phase duration="{most}" minDur="{MIN_GREEN_S}" maxDur="{most}" vehext="2" yellow="{YELLOW_S}" red="{RED_S}" '
              f'name="{number}" state="{state}"/>' for number, (state, most) in NEMA.items()]  # fmt: skip
    return f'<tlLogic id="J" type="NEMA" programID="0" offset="0">{"".join(lines)}</tlLogic>'


def write_net(home, folder, kind):
    ends = {"N": (0, 400), "W": (-400, 0), "S": (0, -400), "E": (400, 0)}
    nodes = '<node id="J" x="0" y="0" type="traffic_light"/>'
    nodes += "".join(f'<node id="{arm}" x="{x}" y="{y}"/>' for arm, (x, y) in ends.items())
    (folder / "n.nod.xml").write_text(f"<nodes>{nodes}</nodes>")
    edges = "".join(f'<edge id="{arm}_in" from="{arm}" to="J" numLanes="2" speed="{SPEED_MPS}"/>'
                    f'<edge id="{arm}_out" from="J" to="{arm}" numLanes="2" speed="{SPEED_MPS}"/>' for arm in ARMS)  # fmt: skip
    (folder / "n.edg.xml").write_text(f"<edges>{edges}</edges>")
    connections = "".join(
        f'<connection from="{arm}_in" to="{target(arm, turn)}_out" fromLane="{lane}" toLane="{lane}"/>'
        for arm in ARMS for turn, lane in (("right", 0), ("straight", 0), ("left", 1)))  # fmt: skip
    (folder / "n.con.xml").write_text(f"<connections>{connections}</connections>")
    plain = folder / "plain.net.xml"
    subprocess.run([home / "bin" / "netconvert", "-n", "n.nod.xml", "-e", "n.edg.xml", "-x", "n.con.xml", "--no-turnarounds",
                    "-o", plain], cwd=folder, check=True, capture_output=True)  # fmt: skip
    text = plain.read_text()
    begin, end = text.index("<tlLogic"), text.index("</tlLogic>") + len("</tlLogic>")
    (folder / "signals.net.xml").write_text(text[:begin] + programme(kind) + text[end:])


def target(arm, turn):
    return ARMS[(ARMS.index(arm) + {"right": 1, "straight": 2, "left": 3}[turn]) % 4]


def write_trips(folder, veh_h, seed):
    """Writes trips with Poisson arrivals."""
    rng = random.Random(seed)
    trips = []
    for arm in ARMS:
        time_s = rng.expovariate(veh_h / 3600)
        while time_s < DURATION_S:
            turn = rng.choices(list(SHARES), SHARES.values())[0]
            trips.append((time_s, f"{arm}_in", f"{target(arm, turn)}_out"))
            time_s += rng.expovariate(veh_h / 3600)
    lines = [f'<trip id="{k}" depart="{time_s:.1f}" from="{a}" to="{b}" departLane="best" departSpeed="max"/>'
             for k, (time_s, a, b) in enumerate(sorted(trips))]  # fmt: skip
    (folder / "trips.xml").write_text(f"<routes>{''.join(lines)}</routes>")


def travel_times(file):
    """Returns first edge, arrival time, duration and last edge of each finished trip. The duration includes the delay
    before departure."""
    return [(trip.get("departLane").rsplit("_", 1)[0], float(trip.get("arrival")),
             float(trip.get("duration")) + float(trip.get("departDelay")), trip.get("arrivalLane").rsplit("_", 1)[0])
            for trip in ElementTree.parse(file).getroot().iter("tripinfo")]  # fmt: skip


def results(trips):
    """Returns throughput in veh/h and mean delay in s. The fastest trip of each turn is the one without delay."""
    fastest = defaultdict(lambda: float("inf"))
    for start, _, duration, end in trips:
        fastest[start, end] = min(fastest[start, end], duration)
    measured = [(duration - fastest[start, end]) for start, arrival, duration, end in trips if arrival >= WARM_UP_S]
    return len(measured) * 3600 / (DURATION_S - WARM_UP_S), statistics.mean(measured)


def run_ours(programs, package, folder, seed):
    scenario = folder / "signals.yaml"
    scenario.write_text(SCENARIO.format(duration=DURATION_S, window=DURATION_S - WARM_UP_S))
    subprocess.run([programs / "stopline-run", scenario, "--seed", str(seed), "--no-figures", "--output", folder / "out",
                    "--tripinfo", folder / "ours.xml"], check=True, capture_output=True)  # fmt: skip
    sys.path.insert(0, str(package))
    import stopline  # pylint: disable=import-outside-toplevel

    simulation = stopline.Simulation(stopline.load(scenario, {"seed": seed}))
    greens = defaultdict(list)  # by signal group: straight with right, and left, of each approach
    since = {}
    while simulation.time_s < DURATION_S:
        simulation.step()
        for group, light in enumerate(simulation.lights):
            if light == "green":
                since.setdefault(group, simulation.time_s)
            elif group in since:
                greens[group].append((since[group], simulation.time_s - since.pop(group)))
    return travel_times(folder / "ours.xml"), mean_green(greens)


def run_sumo(programs, home, folder, seed):
    """Runs SUMO with the inputs of stopline-compare, so that both programs have the same drivers and the same step."""
    environment = {**os.environ, "PATH": f"{home / 'bin'}:{os.environ['PATH']}"}
    subprocess.run([programs / "stopline-compare", "signals.yaml", "--repetitions", "1", "--no-figures", "--output", "compare",
                    "--set", f"seed={seed}"], cwd=folder, env=environment, check=True, capture_output=True)  # fmt: skip
    inputs = next((folder / "compare").glob("seed_*"))
    (inputs / "greens.add.xml").write_text(
        '<additional><timedEvent type="SaveTLSSwitchTimes" source="J" dest="greens.xml"/></additional>')
    subprocess.run([home / "bin" / "sumo", "-c", "run.sumocfg", "-a", "lights.add.xml,detectors.add.xml,greens.add.xml",
                    "--no-step-log", "--no-warnings"], cwd=inputs, check=True, capture_output=True)  # fmt: skip
    greens = defaultdict(list)
    for switch in ElementTree.parse(inputs / "greens.xml").getroot().iter("tlsSwitch"):
        ends = switch.get("fromLane")[0], switch.get("toLane")[0]
        if target(ends[0], "right") != ends[1]:  # right turns have the green of the straight movement
            greens[ends].append((float(switch.get("begin")), float(switch.get("duration"))))
    return travel_times(inputs / "trips.out.xml"), mean_green(greens)


def mean_green(greens):
    """Returns the mean over the greens of all movements after the warm-up."""
    return statistics.mean(duration for group in greens.values() for begin, duration in group if begin >= WARM_UP_S)


def compare(options, home, folder, kind, veh_h):
    rows = []
    for seed in range(1, options.seeds + 1):
        write_net(home, folder, kind)
        write_trips(folder, veh_h, seed)
        ours_trips, ours_green = run_ours(options.programs, options.package, folder, seed)
        sumo_trips, sumo_green = run_sumo(options.programs, home, folder, seed)
        rows.append((*results(ours_trips), ours_green, *results(sumo_trips), sumo_green))
    return [statistics.mean(column) for column in zip(*rows)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=lambda path: Path(path).resolve())
    parser.add_argument("package", type=lambda path: Path(path).resolve(), nargs="?", default=Path("build/release/python").resolve())
    parser.add_argument("--seeds", type=int, default=2, help="number of runs of each program (default: 2)")
    parser.add_argument("--only", default="", help="part of the name of a controller")
    options = parser.parse_args()
    home = sumo_home()
    if home is None or not (options.package / "stopline").is_dir():
        print("skipped: SUMO or the Python package is missing")
        return 77
    print(f"{'controller':17} {'veh/h':>6} | {'throughput, veh/h':>24} | {'delay, s':>20} | {'green, s':>20}")
    failed = False
    for kind in CONTROLLERS:
        if options.only not in kind:
            continue
        for veh_h in DEMANDS_VEH_H:
            with tempfile.TemporaryDirectory() as temporary:
                ours = compare(options, home, Path(temporary), kind, veh_h)
            throughput, delay, green, sumo_throughput, sumo_delay, sumo_green = ours
            more = 100 * (throughput / sumo_throughput - 1), 100 * (delay / sumo_delay - 1), green - sumo_green
            marks = ["!" if abs(value) > limit else " " for value, limit in zip(more, LIMITS.values())]
            failed = failed or "!" in marks
            print(f"{kind:17} {veh_h:6} | {throughput:7.0f} {sumo_throughput:7.0f} {more[0]:+6.1f} %{marks[0]} | "
                  f"{delay:5.1f} {sumo_delay:5.1f} {more[1]:+6.1f} %{marks[1]} | {green:5.1f} {sumo_green:5.1f} {more[2]:+6.1f} s{marks[2]}",
                  flush=True)  # fmt: skip
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
