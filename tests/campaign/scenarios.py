"""Random scenarios of all kinds of networks, vehicles, drivers, policies and signals.

Most values are ordinary. Some are at the border of what the fields allow, because faults often show there. A scenario
is a dict, as YAML would give it. Not every scenario is valid: the program refuses some of them, with a reason.
"""

import random
import sys
from pathlib import Path

TESTS = Path(__file__).resolve().parent.parent
DATA = TESTS / "data"
sys.path.insert(0, str(TESTS / "sumo"))

import random_corridors  # noqa: E402

POLICIES = ["CDG", "CDG-6m", "CTG-Ref", "CTG-HCM", "CTG-HBS", "SWITCH-1", "SWITCH-1-6m", "SWITCH-2", "HUMAN"]
CARS = ["petrol_eu4_72kw", "petrol_eu4_84kw", "diesel_eu4_103kw", "electric_100kw"]
# Vehicle and driver.
FLEET = [(car, None) for car in CARS] + [("rigid_lorry_12t", "lorry"), ("articulated_lorry_35t", "lorry"),
                                         ("city_bus_12m", "bus")]  # fmt: skip
LAWS = ["constant_distance", "constant_time", "switch_time_gap", "switch_distance", "formula", "table", "human"]
MESO = ["table2", "fitted", "passages", "start", "start_passages"]
LANES = [
    ["straight"], ["straight+left+right"], ["straight+left"], ["straight+right"], ["left+right"],
    ["straight+left", "straight+right"], ["left", "straight+right"], ["straight", "straight+right"],
    ["straight+left", "straight", "straight+right"], ["left", "straight", "straight+right"],
    ["left", "straight+left", "straight+right"], ["left", "straight", "right"],
    ["left", "straight", "straight", "straight+right"],
]  # fmt: skip
SIDES = ["west", "south", "east", "north"]
# Imported networks. With route files, or with pairs of the first and the last edge of trips.
NETS_WITH_ROUTES = ["fast_random", "left_turns", "lights_grid", "never_green", "roundabout", "short_edges",
                    "speed_drop", "wrong_turn_lane"]  # fmt: skip
FOUR_WAY = [(f"{a}i", f"{b}o") for a in "nesw" for b in "nesw" if a != b]
ROUNDABOUT = [(f"i{a}", f"x{b}") for a in range(4) for b in range(4) if a != b]
NETS_WITH_TRIPS = {
    "right_of_way/minor_road": [("ac", "cd"), ("bc", "cd")],
    "right_of_way/merge_signal": [("ac", "cd"), ("bc", "cd")],
    "right_of_way/zipper": [("ab", "bc")],
    "right_of_way/full_exit": [("wc", "me"), ("wc", "cn"), ("sc", "me"), ("sc", "cn")],
    "right_of_way/right_before_left": FOUR_WAY,
    "right_of_way/all_way_stop": FOUR_WAY,
    "right_of_way/one_lane_roundabout": ROUNDABOUT,
    "left_turns": FOUR_WAY,
    "wrong_turn_lane": FOUR_WAY,
    "roundabout": ROUNDABOUT,
    "three_lanes": [("ab", "bc")],
    "fast_lane_drop": [("ab", "cd")],
    "short_edges": [("e0", "e14")],
    "crawling_exit": [("nc", "cs"), ("nc", "me"), ("sc", "me"), ("sc", "cn"), ("wc", "cs"), ("wc", "me"), ("wc", "cn")],
    "short_exit": [("wc", "de"), ("wc", "dn"), ("wc", "cs"), ("nc", "cs"), ("nc", "de"), ("sd", "de"), ("sd", "dn")],
    "short_weave": [("in", "straight"), ("in", "right")],
    "speed_drop": [("ab", "bc")],
}  # fmt: skip


class ScenarioDraw:
    """Draws a random scenario. The same seed gives the same scenario."""

    def __init__(self, seed):
        self.rng = random.Random(f"campaign {seed}")
        self.seed = seed
        self.files = {}  # further files of the scenario: name and text

    def chance(self, percent):
        return self.rng.random() * 100 < percent

    def number(self, low, high, digits=0):
        value = round(self.rng.uniform(low, high), digits)
        return int(value) if digits == 0 else value

    def edge(self, ordinary, borders, percent=20):
        """Returns one of the values `borders` with a probability of `percent`, else one of the pair `ordinary`."""
        return self.rng.choice(borders) if self.chance(percent) else self.number(*ordinary)

    def some(self, fields, percent=25):
        """Returns each field of a dict with a probability of `percent`. A value can be a function that draws it."""
        return {key: value() if callable(value) else value for key, value in fields.items() if self.chance(percent)}

    def scenario(self):
        kind = self.rng.choices(["approach", "intersection", "grid", "streets", "sumo"], [18, 32, 20, 12, 18])[0]
        fidelity = self.rng.choices(["meso", "full"], [55, 45])[0]
        fields = {"seed": self.number(1, 10**6), "fidelity": fidelity}
        if fidelity == "full":
            fields["step"] = self.rng.choice(["10 ms", "20 ms", "20 ms", "5 ms", "4 ms"])
        elif self.chance(70):
            fields["meso"] = {"base": self.rng.choice(MESO), "step": f"{self.rng.choice([0.05, 0.1, 0.1, 0.2, 0.5])} s"}
        fields["duration"] = f"{self.number(60, 240) if fidelity == 'meso' else self.number(40, 120)} s"
        fields.update(getattr(self, kind)())
        if kind == "approach" and fidelity == "meso":
            fields["network"]["approach"]["gradient"] = "0 %"  # only full dynamics has slopes
        self.add_population(fields)
        if self.chance(60):
            fields["driver"] = self.driver()
        if kind != "approach" and self.chance(50):
            fields["rules"] = self.rules()
        return fields

    # Networks.

    def approach(self):
        road = {"lanes": self.rng.choice([1, 1, 1, 2, 3]), "length": f"{self.number(150, 900)} m",
                "exit_length": f"{self.edge((50, 600), [10, 20])} m",
                "speed_limit": f"{self.rng.choice([10, 30, 50, 50, 50, 70, 100, 130])} km/h",
                "gradient": f"{self.edge((-4, 4), [0, -8, 8])} %"}  # fmt: skip
        signal = {"first_green": f"{self.number(0, 40)} s", "green": f"{self.edge((5, 60), [1, 2])} s"}
        if self.chance(60):
            green_s = float(signal["green"].split()[0])
            signal.update({"cycle": f"{green_s + self.number(10, 60):g} s", "yellow": f"{self.rng.choice([0, 1, 3])} s",
                           "all_red": "0 s"})  # fmt: skip
        queue = {"kind": "queue", "vehicles": self.number(1, 20)}
        demand = self.rng.choice([queue, self.rate(1), {"kind": "saturated"}])
        return {"network": {"kind": "approach", "approach": road}, "signal": signal, "demand": demand}

    def layout(self):
        lanes = self.rng.choice(LANES)
        layout = {"lanes": [{"movements": lane} for lane in lanes]}
        layout.update(self.some({
            "radius": lambda: f"{self.edge((10, 30), [8, 10, 13, 40])} m",
            "approach_length": lambda: f"{self.edge((80, 300), [50, 60])} m",
            "exit_length": lambda: f"{self.edge((40, 200), [20, 25])} m",
            "lane_width": lambda: f"{self.number(2.5, 5, 1)} m",
            "speed_limit": lambda: f"{self.rng.choice([10, 20, 30, 50, 60, 80, 100])} km/h",
            "turn_speed": lambda: f"{self.edge((4, 11), [1, 2, 3, 14, 20])} m/s",
            "clearance": lambda: f"{self.number(1, 3, 1)} m",
        }, 40))  # fmt: skip
        return layout, lanes

    def times(self):
        """Returns green, yellow and all-red times."""
        return {"green": f"{self.edge((5, 40), [0.6, 1, 1, 2, 3, 4])} s", "yellow": f"{self.edge((2, 5), [0, 0, 1])} s",
                "all_red": f"{self.edge((1, 6), [0, 0, 1])} s"}  # fmt: skip

    def signal(self, lanes):
        movements = sorted({turn for lane in lanes for turn in lane.split("+")})
        signal = {"first_green": f"{self.edge((0, 15), [0, 1])} s"}
        choice = self.rng.choices(["plain", "phases", "actuated", "dual_ring"], [50, 15, 25, 10])[0]
        if choice == "plain":
            signal.update(self.times())
            return signal | self.some({"cross_green": lambda: f"{self.number(4, 30)} s"}, 15)
        named = lambda side, turns: [f"{side}_{turn}" for turn in turns if turn in movements]  # noqa: E731
        phases = []
        if choice == "dual_ring":
            for ring in (1, 2):
                for barrier, pair in ((1, ("west", "east")), (2, ("south", "north"))):
                    left, through = pair if ring == 1 else pair[::-1]
                    if "left" in movements and "left" in lanes:
                        phases.append({"protected": named(left, ["left"]), "ring": ring, "barrier": barrier})
                    place = {"ring": ring, "barrier": barrier}
                    phases.append({"protected": named(through, ["straight", "right"]),
                                   "permissive": named(through, ["left"]), **place})  # fmt: skip
        else:
            for pair in (("west", "east"), ("south", "north")):
                if "left" in lanes and self.chance(60):
                    phases.append({"protected": [name for side in pair for name in named(side, ["left"])]})
                phases.append({"protected": [name for side in pair for name in named(side, ["straight", "right"])],
                               "permissive": [name for side in pair for name in named(side, ["left"])]})  # fmt: skip
            if self.chance(10):
                phases.append({})
        for phase in phases:
            phase.update(self.times())
            if choice != "phases":
                phase.update(self.some({
                    "min_green": lambda: f"{self.edge((3, 8), [0.1, 1])} s",
                    "max_green": lambda: f"{self.number(10, 60)} s",
                    "gap": lambda: f"{self.edge((1, 4), [0.1, 0.5], 10)} s",
                    "recall": lambda: self.rng.choice(["minimum", "maximum"])}, 30))  # fmt: skip
        signal["phases"] = [{key: value for key, value in phase.items() if value != []} for phase in phases]
        if choice != "phases":
            signal["controller"] = choice
            signal.update(self.some({"stop_detector": lambda: f"{self.number(0, 10)} m",
                                     "advance_detector": lambda: f"{self.edge((20, 80), [0])} m"}))  # fmt: skip
            if choice == "actuated":
                signal.update(self.some({"platoon_range": lambda: f"{self.number(20, 300)} m"}))
        return signal

    def turns(self, lanes):
        shares = {}
        for turn in ("left", "right"):
            if any(turn in lane and "+" in lane for lane in lanes) and self.chance(70):
                shares[turn] = f"{self.rng.choice([0, 5, 10, 20, 30, 45])} %"
        return shares | self.some({"order": "random"}, 20)

    def rate(self, lanes):
        demand = {"kind": "rate", "inflow": f"{self.edge((100, 1500), [1, 4000]) * lanes} veh/h"}
        demand.update(self.some({"arrivals": lambda: self.rng.choice(["poisson", "platooned"])}, 40))
        if self.chance(20):
            demand["profile"] = [{"from": "0 min", "inflow": "50 %"}, {"from": "1 min", "inflow": "150 %"}]
            demand.update(self.some({"profile_shape": "linear"}))
        return demand

    def junction_demand(self, lanes):
        if self.chance(60):
            demand = {"kind": "saturated"} | self.some({"cross_inflow": lambda: f"{self.number(50, 1000)} veh/h"}, 10)
        else:
            demand = self.rate(len(lanes))
        demand.update(self.turns(lanes))
        return demand | self.some({"start": "queued", "entry_speed": lambda: f"{self.edge((10, 50), [0, 5])} km/h"}, 25)

    def intersection(self):
        layout, lanes = self.layout()
        fields = {"network": {"kind": "intersection", "intersection": layout}, "signal": self.signal(lanes),
                  "demand": self.junction_demand(lanes), "measure": {"warmup_cycles": 0}}  # fmt: skip
        if self.chance(50):
            fields["duration"] = "0 s"  # the run ends after the measured cycles
            fields["measure"]["cycles"] = self.number(1, 4)
        return fields

    def grid(self):
        layout, lanes = self.layout()
        columns, rows = self.rng.choice([(2, 1), (3, 1), (1, 2), (4, 1), (2, 2), (2, 3), (3, 3)])
        grid = {"columns": columns, "rows": rows}
        grid.update(self.some({"column_spacing": lambda: f"{self.edge((120, 320), [80, 100])} m",
                               "row_spacing": lambda: f"{self.edge((120, 320), [80, 100])} m"}, 60))  # fmt: skip
        if (columns, rows) == (3, 3) and self.chance(30):
            grid["shape"] = "without_corners"
        signal = self.signal(lanes) | self.some({"offset": lambda: f"{self.number(1, 30)} s"}, 40)
        return {"network": {"kind": "grid", "intersection": layout, "grid": grid}, "signal": signal,
                "demand": self.junction_demand(lanes), "measure": {"window": "30 s"}}  # fmt: skip

    def streets(self):
        text, _ = random_corridors.streets_text(self.seed)
        if self.chance(30):
            text = text.replace("median: 4 m\n", f"median: 4 m\npassing_clearance: {self.number(2, 3.5, 1)} m\n")
        self.files["streets.yaml"] = text
        fields = {"network": {"kind": "streets", "streets": "./streets.yaml"}, "measure": {"window": "30 s"}}
        fields["demand"] = {"kind": "saturated"} if self.chance(70) else self.rate(2)
        if self.chance(25):
            fields["signal"] = {"controller": "actuated"}
        return fields

    def sumo(self):
        network = {"kind": "sumo"}
        if self.chance(35):
            name = self.rng.choice(NETS_WITH_ROUTES)
            routes = str(DATA / f"{name}.rou.xml")
        else:
            name = self.rng.choice(sorted(NETS_WITH_TRIPS))
            self.files["trips.rou.xml"] = self.trips(NETS_WITH_TRIPS[name])
            routes = "./trips.rou.xml"
        network.update({"net": str(DATA / f"{name}.net.xml"), "routes": [routes]})
        if self.chance(30):
            network["vehicles"] = "from_routes"
        return {"network": network, "measure": {"window": "30 s"}}

    def trips(self, pairs):
        count = self.number(3, 60)
        lines = []
        vehicle_type = ""
        if self.chance(30):
            lines.append(f'<vType id="t" length="{self.edge((4, 12), [1, 2, 18])}" minGap="{self.number(2, 4, 1)}" '
                         f'tau="{self.number(0.5, 2, 1)}" accel="{self.number(0.8, 3, 1)}" '
                         f'decel="{self.number(3, 5, 1)}" maxSpeed="{self.number(5, 40)}"/>')  # fmt: skip
            vehicle_type = ' type="t"'
        for k, depart_s in enumerate(sorted(self.number(0, 120, 1) for _ in range(count))):
            first, last = self.rng.choice(pairs)
            lines.append(f'<trip id="{k}"{vehicle_type} depart="{depart_s}" from="{first}" to="{last}" '
                         f'departSpeed="{self.rng.choice(["max", "0", "8", "last"])}" '
                         f'departLane="{self.rng.choice(["best", "free", "first"])}"/>')  # fmt: skip
        return "<routes>\n" + "\n".join(lines) + "\n</routes>\n"

    # Policies, vehicles and drivers.

    def own_policy(self, name, fidelity):
        borders = [2, 2.0, 2.1] if fidelity == "full" else [0.1, 0.2, 0.5, 0.7, 1]
        policy = {"name": name, "law": self.rng.choice(LAWS)}
        gap_m = self.edge((2, 8, 2), borders, 30)
        policy["standstill_gap"] = f"{gap_m} m"
        if policy["law"] in ("constant_time", "switch_time_gap", "human"):
            policy["time_gap"] = f"{self.edge((0.3, 2, 2), [0, 0.1])} s"
        if policy["law"].startswith("switch"):
            policy["switch_speed"] = f"{self.edge((5, 60), [0, 1, 100])} km/h"
        if policy["law"] == "switch_distance":
            switch_kmh = float(policy["switch_speed"].split()[0])
            policy["reference_speed"] = f"{switch_kmh + self.number(1, 60)} km/h"
            policy["reference_gap"] = f"{gap_m + self.number(0, 20, 2):.2f} m"
        if policy["law"] == "formula":
            policy["gap"] = self.rng.choice(["s0", "s0 + 0.3 s * v", "s0 + 0.4 s * v + 0.01 s2/m * v^2",
                                             "if(v < 30 km/h, s0, s0 + 0.5 s * (v - 30 km/h))"])  # fmt: skip
        if policy["law"] == "table":
            policy["gaps"] = {"20 km/h": f"{gap_m + 1:.2f} m", "50 km/h": f"{gap_m + self.number(1, 15, 1):.2f} m"}
        if policy["law"] in ("formula", "table") or self.chance(10):
            policy["mesoscale"] = self.rng.choice(["time_gap", "constant_distance", "idm", "human"])
        return policy

    def add_population(self, fields):
        own = [self.own_policy(f"own_{k}", fields["fidelity"]) for k in range(self.rng.choice([0, 0, 0, 1, 1, 2]))]
        names = [policy["name"] for policy in own] + self.rng.sample(POLICIES, 3)
        names = names[: self.rng.choice([1, 1, 2, 3])]
        shares = [100 // len(names)] * len(names)
        shares[0] += 100 - sum(shares)
        components = [{"policy": name, "share": f"{share} %"} for name, share in zip(names, shares)]
        if self.chance(25):
            for component in components:
                component["vehicle"], driver = self.rng.choice(FLEET)
                if driver:
                    component["driver"] = driver
        elif self.chance(70):
            fields["vehicle"] = {"base": self.rng.choice(CARS)} | self.some(
                {"length": lambda: f"{self.edge((3, 12), [0.5, 18, 25])} m",
                 "load": lambda: f"{self.number(0, 600)} kg"}, 25)  # fmt: skip
        own = [policy for policy in own if policy["name"] in names]
        if own:
            fields["policies"] = own
        pattern = self.rng.choice(["alternating", "random", "balanced"])
        fields["populations"] = [{"name": "X", "pattern": pattern, "components": components}]

    def driver(self):
        change = {
            "gap_share": lambda: f"{self.edge((50, 150), [0, 200])} %",
            "urgent_gap_share": lambda: f"{self.edge((10, 100), [0])} %",
            "look_ahead_time": lambda: f"{self.edge((5, 20), [0, 100])} s",
            "gap_opening": lambda: self.rng.choice(["off", "cooperative"]),
            "look_ahead": "off", "politeness": lambda: self.number(0, 1, 1),
            "keep_right": lambda: f"{self.number(0, 1, 1)} m/s2", "pause": lambda: f"{self.edge((1, 10), [0])} s",
        }  # fmt: skip
        sections = {
            "cacc": {"radar_delay": lambda: f"{self.rng.choice([0, 40, 100, 150, 200])} ms",
                     "v2v_delay": lambda: f"{self.rng.choice([20, 40, 100])} ms"},
            "free_drive": {"hesitation": lambda: f"{self.number(0, 2, 1)} s"},
            "stop": {"margin": lambda: f"{self.edge((0.5, 3, 1), [0.1, 10])} m",
                     "deceleration": lambda: f"{self.number(1.5, 3.5, 1)} m/s2",
                     "decision_deceleration": lambda: f"{self.number(2.5, 7, 1)} m/s2"},
            "give_way": {"critical_gap": lambda: f"{self.edge((2, 8, 1), [0, 20])} s",
                         "critical_lag": lambda: f"{self.edge((2, 8, 1), [0, 20])} s",
                         "margin": lambda: f"{self.edge((0.2, 2, 1), [0])} m",
                         "approach_acceleration": lambda: f"{self.number(0.5, 4, 1)} m/s2"},
            "lane_change": change,
            "human": {"reaction": lambda: f"{self.edge((0.5, 1.5, 2), [0, 2])} s", "reaction_spread": "0 s",
                      "gap_error": lambda: self.number(0, 0.3, 2),
                      "start_reaction": lambda: f"{self.number(0.3, 1.5, 1)} s"},
            "platoon": {"max_vehicles": lambda: str(self.rng.choice([1, 2, 5, "by_stability"]))},
        }  # fmt: skip
        driver = {"base": "startup_kit"}
        for name, fields in sections.items():
            drawn = self.some(fields, 20)
            if drawn:
                driver[name] = drawn
        if self.chance(25):
            channel = self.rng.choice(["bernoulli", "gilbert", "delivery_over_distance"])
            driver["v2v"] = {"channel": channel} | self.some({"topology": "predecessor_and_leader"}, 30)
            if channel == "delivery_over_distance":
                driver["v2v"]["delivery"] = "cv2x_4_subchannels"
            else:
                driver["v2v"]["loss"] = f"{self.edge((1, 60), [99])} %"
        if self.chance(15):
            driver["speed_advice"] = {"mode": "glosa", "range": f"{self.number(50, 500)} m"}
        return driver

    def rules(self):
        rules = self.some({"keep_clear": "off", "teleport_cycles": 3, "pass_blocker_greens": 2}, 25)
        if "keep_clear" not in rules:
            rules.update(self.some({"clearing": "cooperative", "count_queue_at_red_exit": "off",
                                    "sight": lambda: f"{self.edge((20, 300), [1])} m"}))  # fmt: skip
        return rules
