"""SUMO's inputs for streets: detectors and saturated demand, from the files that stopline-export wrote.

Names of lanes are those of stopline-run, such as suarezstr_west_in_0. Lanes are counted from the left, in SUMO from the
right. An approach with turn pockets consists of several edges in SUMO: NAME.1, NAME.2, ..., NAME.
"""

import csv
import random
import re
import xml.etree.ElementTree as ElementTree
from collections import defaultdict

SIDES = ["west", "south", "east", "north"]
TURNS = ["straight", "right", "left"]
EDGE = re.compile(r"(?P<approach>.+_(?P<side>west|south|east|north))_(?P<kind>in|out)(\.(?P<part>\d+))?$")
HEADWAY_S = 1.5    # between planned departures on one inlet lane; shorter than the headway of a discharging queue
MAX_DELAY_S = 1.6  # a vehicle that has waited longer is dropped, so that one or two wait on each lane


def turn_of(edge, next_edge):
    """Returns the turn that leads from one edge to the next."""
    entered, left = EDGE.match(edge), EDGE.match(next_edge)
    side = SIDES.index(left["side"])
    if left["kind"] == "in":  # the approach of the next intersection begins at the opposite side of this one
        side = (side + 2) % 4
    turn = (side - SIDES.index(entered["side"])) % 4
    return {2: "straight", 1: "right", 3: "left"}[turn]


class Streets:
    """The exported network."""

    def __init__(self, folder):
        self.lanes = {}                  # number of lanes by edge
        for edge in ElementTree.parse(folder / "edges.edg.xml").getroot().iter("edge"):
            self.lanes[edge.get("id")] = int(edge.get("numLanes"))
        self.turns = defaultdict(dict)   # next edge by edge and turn
        self.allowed = defaultdict(set)  # turns by edge and lane
        self.next_part = {}              # next edge of the same approach
        self.previous = {}               # edge and lane upstream in the same approach, by edge and lane
        for c in ElementTree.parse(folder / "connections.con.xml").getroot().iter("connection"):
            begin, end = c.get("from"), c.get("to")
            if EDGE.match(begin)["approach"] == EDGE.match(end)["approach"]:
                self.next_part[begin] = end
                self.previous[end, int(c.get("toLane"))] = begin, int(c.get("fromLane"))
                continue
            turn = turn_of(begin, end)
            self.turns[begin][turn] = end
            self.allowed[begin, int(c.get("fromLane"))].add(turn)

    def cycle_s(self, folder):
        """Returns the common cycle of the signals."""
        logics = list(ElementTree.parse(folder / "lights.tll.xml").getroot().iter("tlLogic"))
        cycles = {round(sum(float(phase.get("duration")) for phase in logic), 3) for logic in logics}
        if len(cycles) != 1:
            raise SystemExit(f"the signals have different cycles: {sorted(cycles)} s")
        return cycles.pop()

    def parts(self, edge):
        """Returns the edges of an approach from this edge to the stop line."""
        edges = [edge]
        while edges[-1] in self.next_part:
            edges.append(self.next_part[edges[-1]])
        return edges

    def inlets(self):
        """Returns the edges where vehicles enter the network."""
        reached = set(self.next_part.values()) | {edge for turns in self.turns.values() for edge in turns.values()}
        return sorted(edge for edge in self.lanes if edge not in reached and EDGE.match(edge)["kind"] == "in")

    def sumo_lane(self, lane):
        """Returns SUMO's name of a lane. If its approach has several edges, this is the lane of the last edge."""
        edge, number = lane.rsplit("_", 1)
        return f"{edge}_{self.lanes[edge] - 1 - int(number)}"


def write_detectors(file, streets, names, margin_m, cycle_s):
    """Writes an induction loop for each detector of stopline-run: LANE_stop_line, or LANE_zone0 on the border of the
    measured area."""
    loops = []
    for name in names:
        lane, kind = re.match(r"(.+_\d+)_(stop_line|zone0)$", name).groups()
        entering = EDGE.match(lane.rsplit("_", 1)[0])["kind"] == "in"
        position = -0.1 if kind == "stop_line" else -margin_m if entering else margin_m
        loops.append(f'<inductionLoop id="{name}" lane="{streets.sumo_lane(lane)}" pos="{position}" '
                     f'period="{cycle_s}" file="loops.xml"/>')
    file.write_text("<additional>\n" + "\n".join(loops) + "\n</additional>\n")


def read_turn_shares(file):
    """Returns the turn shares of each approach, from turns.csv of stopline-run. They are those of the streets file."""
    shares = {}
    with open(file, newline="", encoding="utf-8") as rows:
        for row in csv.DictReader(rows):
            right, left = (float(row[f"{turn}_target_percent"]) / 100 for turn in ("right", "left"))
            shares[row["approach"]] = {"straight": 1 - right - left, "right": right, "left": left}
    return shares


def shares_by_lane(allowed, shares):
    """Spreads the turns of an approach over its inlet lanes, so that all lanes carry equal traffic (iterative
    proportional fitting, as in core/demand/turn_shares.h). `allowed` lists the turns of each lane."""
    rows = [{turn: float(turn in turns and shares[turn] > 0) for turn in TURNS} for turns in allowed]
    for _ in range(1000):
        for row in rows:
            total = sum(row.values())
            for turn in TURNS:
                row[turn] *= 1 / len(rows) / total if total > 0 else 0
        for turn in TURNS:
            total = sum(row[turn] for row in rows)
            for row in rows:
                row[turn] *= shares[turn] / total if total > 0 else 0
    return [row if sum(row.values()) > 0 else dict(shares) for row in rows]


def draw(rng, shares):
    turns = [turn for turn in TURNS if shares[turn] > 1e-9]
    return rng.choices(turns, [shares[turn] for turn in turns])[0]


def inlet_shares(streets, inlet, shares):
    """Returns the turn shares of each lane of an inlet, from the right. A turn that only a pocket allows is assigned to
    the inlet lane from which vehicles reach the pocket."""
    allowed = [set() for _ in range(streets.lanes[inlet])]
    last = streets.parts(inlet)[-1]
    for lane in range(streets.lanes[last]):
        place = last, lane
        while place[0] != inlet:
            place = streets.previous[place]
        allowed[place[1]] |= streets.allowed[last, lane]
    return shares_by_lane(allowed, shares)


def write_demand(file, streets, shares, vehicle_type, duration_s, seed):
    """Writes saturated demand: on each inlet lane, vehicles depart faster than a queue discharges. The first turn is
    drawn from the shares of the inlet lane, each later turn from the shares of its approach. Vehicles are named
    INLET.LANE.NUMBER.TURN. A longer duration only adds vehicles at the end."""
    routes, vehicles = {}, []
    for inlet in streets.inlets():
        for lane, lane_shares in enumerate(inlet_shares(streets, inlet, shares[EDGE.match(inlet)["approach"]])):
            rng = random.Random(f"{seed} {inlet} {lane}")
            first_s = rng.random() * HEADWAY_S
            for k in range(int(duration_s / HEADWAY_S)):
                edges = streets.parts(inlet)
                turn = first = draw(rng, lane_shares)
                while True:
                    edges += streets.parts(streets.turns[edges[-1]][turn])
                    if EDGE.match(edges[-1])["kind"] == "out":
                        break
                    turn = draw(rng, shares[EDGE.match(edges[-1])["approach"]])
                route = routes.setdefault(" ".join(edges), f"r{len(routes)}")
                vehicles.append((first_s + k * HEADWAY_S, f"{inlet}.{lane}.{k}.{first}", route, lane))
    vehicles.sort()
    with open(file, "w", encoding="utf-8") as out:
        out.write(f"<routes>\n{vehicle_type}\n")
        out.writelines(f'<route id="{name}" edges="{edges}"/>\n' for edges, name in routes.items())
        out.writelines(f'<vehicle id="{name}" type="car" route="{route}" depart="{depart_s:.1f}" departLane="{lane}" '
                       f'departPos="base" departSpeed="max"/>\n' for depart_s, name, route, lane in vehicles)
        out.write("</routes>\n")


def insertion_faults(streets, shares, inserted, run_s):
    """Checks the vehicles that SUMO inserted: {"INLET.LANE": {turn: number}}. A vehicle must always
    have waited on each inlet lane. SUMO has then dropped some of the planned vehicles. The first turns must have their
    shares, within four standard deviations. Returns the faults as sentences."""
    faults = []
    for inlet in streets.inlets():
        for lane, lane_shares in enumerate(inlet_shares(streets, inlet, shares[EDGE.match(inlet)["approach"]])):
            counts = inserted.get(f"{inlet}.{lane}", {})
            number = sum(counts.values())
            if number > 0.98 * run_s / HEADWAY_S:
                faults.append(f"demand on lane {inlet}_{lane} is not saturated")
            for turn in TURNS:
                share = lane_shares[turn] / sum(lane_shares.values())
                deviation = (number * share * (1 - share)) ** 0.5
                if abs(counts.get(turn, 0) - number * share) > 4 * deviation + 1:
                    faults.append(f"{counts.get(turn, 0)} of {number} vehicles on lane {inlet}_{lane} turn {turn}, "
                                  f"expected {number * share:.0f}")
    return faults
