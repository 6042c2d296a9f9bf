"""Compares the counts of two programs on streets: totals, inflow by side, and lane use by approach."""

import re
from collections import defaultdict

SIDES = ["west", "south", "east", "north"]
SHORT_HEADING = ("                                ours     SUMO  difference  worst lane      ours      SUMO\n"
                 "                             vehicles a minute          veh/cycle      teleported")


def mean(values):
    values = list(values)
    return sum(values) / len(values) if values else float("nan")


class Totals:
    """Totals of the counts of one program, from the given signal cycle on."""

    def __init__(self, runs, first_cycle, cycle_s):
        self.first, self.minutes_a_cycle, self.runs = first_cycle, cycle_s / 60, runs
        self.teleported = mean(run.teleported for run in runs)

    def of(self, matches, first=None, last=None):
        """Returns one value for each run: vehicles per minute, summed over the detectors whose name matches."""
        by_run = []
        for run in self.runs:
            counted = [cycles[self.first if first is None else first:last] for name, cycles in run.counts.items()
                       if matches(name)]
            cycles = len(counted[0]) if counted else 1
            by_run.append(sum(map(sum, counted)) / max(cycles, 1) / self.minutes_a_cycle)
        return by_run

    def leaving(self, side=None, **window):
        pattern = re.compile(rf"_({side or '|'.join(SIDES)})_out_\d+_zone0$")
        return self.of(pattern.search, **window)

    def entering(self, side):
        return self.of(re.compile(rf"_{side}_in_\d+_zone0$").search)

    def lane_use(self):
        """Returns the vehicles a cycle at each stop line: {approach: [lanes from the left]}."""
        lanes = defaultdict(dict)
        for name in self.runs[0].counts:
            found = re.match(r"(.+)_in_(\d+)_stop_line$", name)
            if found:
                lanes[found[1]][int(found[2])] = mean(mean(run.counts[name][self.first:]) for run in self.runs)
        return {approach: [by_lane[k] for k in sorted(by_lane)] for approach, by_lane in lanes.items()}


def percent(ours, theirs):
    return 100 * (ours / theirs - 1) if theirs else float("nan")


def spread(values):
    return f"{mean(values):7.1f} ({min(values):.0f}..{max(values):.0f})"


class Comparison:
    """Our runs beside SUMO's."""

    def __init__(self, name, ours, sumo):
        self.name, self.ours, self.sumo = name, ours, sumo
        self.total = mean(ours.leaving()), mean(sumo.leaving())
        self.difference_percent = percent(*self.total)
        use = ours.lane_use(), sumo.lane_use()
        self.lanes = [(approach, k, use[0][approach][k], use[1][approach][k])
                      for approach in use[0] for k in range(len(use[0][approach]))]
        self.use = use
        self.worst_lane = max(self.lanes, key=lambda lane: abs(lane[2] - lane[3]))
        self.worst_lane_difference = self.worst_lane[2] - self.worst_lane[3]

    def faults(self, limit_percent, limit_lane):
        """Returns the requirements that are missed, as sentences."""
        missed = []
        if not abs(self.difference_percent) <= limit_percent:
            missed.append(f"throughput differs by {self.difference_percent:+.1f} %, allowed {limit_percent:g} %")
        beyond = sum(abs(ours - theirs) > limit_lane for _, _, ours, theirs in self.lanes)
        if beyond:
            missed.append(f"{beyond} of {len(self.lanes)} lanes differ by more than {limit_lane:g} vehicles a cycle")
        if self.ours.teleported:
            missed.append(f"we teleport {self.ours.teleported:.1f} vehicles in a run")
        return missed + self.notes()

    def notes(self):
        """Returns the sentences about violations and collisions."""
        return [note for run in self.ours.runs + self.sumo.runs for note in run.notes]

    def text(self):
        lines = [f"== {self.name}", "vehicles a minute        ours (seeds)        SUMO (seeds)   difference"]

        def row(title, ours, theirs):
            difference = percent(mean(ours), mean(theirs))
            lines.append(f"{title:18s} {spread(ours):>18s} {spread(theirs):>19s} {difference:+8.1f} %")

        row("leave the area", self.ours.leaving(), self.sumo.leaving())
        cycles = len(next(iter(self.ours.runs[0].counts.values())))
        step = max((cycles - self.ours.first) // 4, 1)
        for first in range(self.ours.first, cycles - step + 1, step):
            window = {"first": first, "last": first + step}
            minutes = [number * self.ours.minutes_a_cycle for number in (first, first + step)]
            title = "  minutes {:.0f} to {:.0f}".format(*minutes)
            row(title, self.ours.leaving(**window), self.sumo.leaving(**window))
        for side in SIDES:
            row(f"leave to {side}", self.ours.leaving(side), self.sumo.leaving(side))
        for side in SIDES:
            row(f"enter from {side}", self.ours.entering(side), self.sumo.entering(side))
        lines.append(f"teleported         {self.ours.teleported:10.1f} {self.sumo.teleported:19.1f}   a run")
        lines += self.lane_lines()
        return "\n".join(lines) + "\n"

    def lane_lines(self):
        lines = ["vehicles a cycle at the stop lines, lanes from the left"]
        for approach, ours in self.use[0].items():
            theirs = self.use[1][approach]
            largest = max((a - b for a, b in zip(ours, theirs)), key=abs)
            lines.append(f"{approach:30s} ours {' / '.join(f'{x:4.1f}' for x in ours):40s} SUMO "
                         f"{' / '.join(f'{x:4.1f}' for x in theirs):40s} largest {largest:+.1f}")
        approach, lane, ours, theirs = self.worst_lane
        lines.append(f"Largest difference of a lane: {approach}, lane {lane + 1} from the left: ours {ours:.1f}, SUMO "
                     f"{theirs:.1f} vehicles a cycle.")
        sums = [(approach, sum(ours), sum(self.use[1][approach])) for approach, ours in self.use[0].items()]
        approach, ours, theirs = max(sums, key=lambda one: abs(one[1] - one[2]))
        lines.append(f"Largest difference of an approach: {approach}: ours {ours:.1f}, SUMO {theirs:.1f} vehicles a "
                     "cycle.")
        return lines

    def short_line(self):
        """Returns a row below SHORT_HEADING."""
        return (f"{self.name:28s} {self.total[0]:8.1f} {self.total[1]:8.1f} {self.difference_percent:+9.1f} %"
                f" {self.worst_lane_difference:+11.1f} {self.ours.teleported:9.1f} {self.sumo.teleported:9.1f}")

    def csv_rows(self):
        """Returns rows of name, place, lane, our value and SUMO's value."""
        rows = [(self.name, "leave_per_minute", "", *self.total)]
        for side in SIDES:
            for kind, total in (("leave", Totals.leaving), ("enter", Totals.entering)):
                rows.append((self.name, f"{kind}_{side}_per_minute", "", mean(total(self.ours, side)),
                             mean(total(self.sumo, side))))
        rows.append((self.name, "teleported", "", self.ours.teleported, self.sumo.teleported))
        return rows + [(self.name, approach, k + 1, ours, theirs) for approach, k, ours, theirs in self.lanes]
