"""Makes a failing scenario smaller, as long as it still fails in the same way."""

import copy
import re

QUANTITY = re.compile(r"^(-?\d+(?:\.\d+)?)( .*)?$")


def places(value, path=()):
    """Returns the paths of all entries of nested dicts and lists, outer ones first."""
    found = []
    entries = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, entry in entries:
        found.append((*path, key))
        found += places(entry, (*path, key))
    return found


def parent_of(scenario, path):
    for key in path[:-1]:
        scenario = scenario[key]
    return scenario


def without(scenario, path):
    """Returns the scenario without an entry; None if the entry does not exist or cannot be left out."""
    smaller = copy.deepcopy(scenario)
    try:
        del parent_of(smaller, path)[path[-1]]
    except (KeyError, IndexError, TypeError):
        return None
    return smaller


def simpler_numbers(value):
    """Returns simpler values for a number with or without a unit: whole numbers, and about half of the value."""
    match = QUANTITY.match(str(value))
    if not match:
        return []
    number, unit = float(match[1]), match[2] or ""
    candidates = []
    for simpler in (round(number), round(number / 2), round(number / 2, 1)):
        if simpler != number and abs(simpler) <= abs(number):
            candidates.append(f"{simpler:g}{unit}" if isinstance(value, str) else int(simpler))
    return candidates


def with_value(scenario, path, value):
    smaller = copy.deepcopy(scenario)
    parent_of(smaller, path)[path[-1]] = value
    return smaller


def value_at(scenario, path):
    try:
        return parent_of(scenario, path)[path[-1]]
    except (KeyError, IndexError, TypeError):
        return None


def with_full_shares(scenario):
    """Changes the share of the first component of each population so that the shares sum to 100 %."""
    for population in scenario.get("populations", []):
        components = population.get("components", []) if isinstance(population, dict) else []
        others = sum(float(component["share"].split()[0]) for component in components[1:])
        if components:
            components[0]["share"] = f"{100 - others:g} %"


class Shrinking:
    """A search for a smaller case. A case is a scenario with further files: {"scenario": dict, "files": {name: text}}.
    `still_fails(case)` returns true if the case still fails in the same way."""

    def __init__(self, case, still_fails, most_runs):
        self.case = case
        self.still_fails = still_fails
        self.runs_left = most_runs

    def accept(self, case):
        """Keeps the case if it still fails."""
        if case == self.case or self.runs_left <= 0:
            return False
        self.runs_left -= 1
        if not self.still_fails(case):
            return False
        self.case = case
        return True

    def accept_scenario(self, scenario):
        if scenario is None:
            return False
        with_full_shares(scenario)
        return self.accept({**self.case, "scenario": scenario})

    def drop_entries(self):
        """Leaves out fields and entries of lists. Shares stay, because with_full_shares() sets them."""
        changed = [self.accept_scenario(without(self.case["scenario"], path))
                   for path in places(self.case["scenario"]) if path[-1] != "share"]  # fmt: skip
        return any(changed)

    def simplify_numbers(self):
        has_changed = False
        for path in places(self.case["scenario"]):
            for value in simpler_numbers(value_at(self.case["scenario"], path)):
                if path[-1] != "share" and self.accept_scenario(with_value(self.case["scenario"], path, value)):
                    has_changed = True
                    break
        return has_changed

    def drop_lines(self):
        """Leaves out lines of route files: first half of them, then a quarter, down to single lines."""
        has_changed = False
        for name in self.case["files"]:
            if not name.endswith(".rou.xml"):
                continue
            count = len(self.case["files"][name].splitlines()) // 2
            while count > 0:
                first = 1
                while first < len(self.case["files"][name].splitlines()) - 1:
                    lines = self.case["files"][name].splitlines()
                    last = min(first + count, len(lines) - 1)
                    text = "\n".join(lines[:first] + lines[last:]) + "\n"
                    if self.accept({**self.case, "files": {**self.case["files"], name: text}}):
                        has_changed = True
                    else:
                        first += count
                count //= 2
        return has_changed


def shrunk(case, still_fails, most_runs=300):
    """Returns a smaller case that still fails. Calls `still_fails` at most `most_runs` times."""
    shrinking = Shrinking(case, still_fails, most_runs)
    while shrinking.runs_left > 0:
        changes = [shrinking.drop_entries(), shrinking.drop_lines(), shrinking.simplify_numbers()]
        if not any(changes):
            break
    return shrinking.case
