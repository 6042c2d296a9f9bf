#!/usr/bin/env python3
"""Checks that includes between the rooms of core/ go one way only, and that folders and files stay small.

    check_includes.py [PROJECT]

Reads every #include "..." of core/ and apps/ in PROJECT (default: the project of this script). A room is a folder of
core/, or a folder of core/sim. The check fails if

  - a room includes a room that is not in its list below, or a file that does not exist,
  - a heavy library is included outside the files that may use it, or in a header of the project,
  - a folder has more than MAX_FILES files, or a file more than MAX_LINES lines,
  - a CMakeLists.txt of core/ links a library of the project that no include of the folder needs,
  - the includes between rooms form a cycle.
"""

import re
import sys
from pathlib import Path

SIM_BELOW = ["base", "network", "signals", "demand", "vehicle", "driver", "spacing_laws", "v2v"]

# The rooms that each room may include besides itself. `measure` may use events and the network, but not vehicles or
# drivers, so metrics cannot depend on the fidelity. `vehicle` and `driver` must not include each other.
ALLOWED = {
    "base": [],
    "network": ["base"],
    "vehicle": ["base"],
    "driver": ["base"],
    "spacing_laws": ["base", "driver"],
    "string_stability": ["base", "driver"],
    "v2v": ["base", "driver", "string_stability"],
    "signals": ["base", "network"],
    "demand": ["base", "network"],
    "sumo_import": ["base", "network", "demand", "signals"],
    "sim/state": SIM_BELOW,
    "sim/perception": SIM_BELOW + ["sim/state", "sim/performance"],
    "sim/performance": SIM_BELOW + ["sim/state"],
    "sim/full_dynamics": SIM_BELOW + ["sim/state", "sim/perception", "sim/performance"],
    "sim/mesoscale": SIM_BELOW + ["sim/state", "sim/perception", "sim/performance"],
    "sim/clearing": SIM_BELOW + ["sim/state", "sim/performance"],
    "sim/junction": SIM_BELOW + ["sim/state", "sim/perception", "sim/performance", "sim/clearing"],
    "sim/speed_advice": SIM_BELOW + ["sim/state", "sim/perception", "sim/clearing", "sim/junction"],
    "sim/lane_change": SIM_BELOW + ["sim/state", "sim/perception"],
    "sim/insertion": SIM_BELOW + ["sim/state", "sim/perception", "sim/lane_change"],
    "sim/congestion": SIM_BELOW + ["sim/state", "sim/perception", "sim/lane_change", "sim/insertion"],
    "sim/step": SIM_BELOW + ["sim/*"],
    "measure": ["base", "network", "sim/state/events.h"],
    "scenario": SIM_BELOW + ["sumo_import", "sim/state/model.h", "sim/mesoscale/following_families.h"],
    "record": ["base", "network", "signals", "sim/*"],
    "reference": ["base"],
    "runs": SIM_BELOW + ["string_stability", "sim/*", "measure", "scenario"],
    "sweeps": ["base", "measure", "scenario", "runs"],
    "signal_timing": ["base", "network", "measure", "scenario", "sim/*", "runs", "sweeps"],
    "calibration": ["base", "driver", "measure", "scenario", "sim/*", "runs", "sweeps"],
    "figures": ["base", "network", "measure", "scenario", "sim/*", "reference", "runs", "sweeps", "signal_timing", "calibration"],
    "paper": ["base", "measure", "scenario", "sim/*", "reference", "runs", "sweeps", "calibration", "figures"],
    "sumo_export": ["base", "network", "signals", "demand", "sumo_import", "sim/*", "measure", "record", "scenario", "runs", "figures"],
}
TOP_FOLDERS = {room.split("/")[0] for room in ALLOWED}

# Libraries that take long to compile, and the only files that may include them.
HEAVY = {
    "yaml-cpp/": r"core/scenario/yaml/yaml_source\.cpp",
    "nlohmann/": r".*\.cpp",
    "CLI/": r"apps/.*\.cpp",
    "fmt/ranges.h": r".*\.cpp",
    "Eigen/": r".*\.cpp",
    "boost/": r".*\.cpp",
    "pugixml": r"core/sumo_import/.*",
}
MAX_LINES = 450
MAX_FILES = 25
SUFFIXES = {".h", ".hpp", ".cpp", ".cc", ".cxx", ".c", ".inl", ".inc", ".ipp"}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def sources(folder):
    return sorted(path for path in folder.rglob("*") if path.is_file() and path.suffix in SUFFIXES)


def includes(path):
    """Yields (line number, '<' or '"', included path) for each include of a file."""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if match:
            yield number, match.group(1), match.group(2)


def room_of(path):
    """Returns the room of a path in core/, for example 'scenario' or 'sim/state'."""
    parts = path.split("/")
    return "/".join(parts[:2]) if parts[0] == "sim" else parts[0]


def may_include(room, included):
    target = room_of(included)
    return any(
        entry in (target, included) or (entry.endswith("/*") and target.startswith(entry[:-1]))
        for entry in [room, *ALLOWED[room]])


def check_core_file(path, project, problems):
    room = room_of(str(path.relative_to(project / "core")))
    where = str(path.relative_to(project))
    if room not in ALLOWED:
        problems.append(f"{where}: core/{room} is not a known room; add it to {Path(__file__).name}")
        return
    for number, quote, included in includes(path):
        place = f"{where}:{number}"
        if "/" in included and included.split("/")[0] in TOP_FOLDERS:
            if quote == "<":
                problems.append(f'{place}: write "{included}" with quotes, as for every file of the project')
            elif not (project / "core" / included).is_file():
                problems.append(f"{place}: there is no core/{included}")
            if not may_include(room, included):
                problems.append(f"{place}: {room} must not include {included}; it may include {', '.join([room, *ALLOWED[room]])}")
        elif quote == '"' and included != "version_text.h":
            problems.append(f'{place}: "{included}" does not begin with a folder of core/ ({", ".join(sorted(TOP_FOLDERS))})')


def check_heavy(files, project, problems):
    for path in files:
        name = str(path.relative_to(project))
        for number, _, included in includes(path):
            for library, users in HEAVY.items():
                if included.startswith(library) and not re.fullmatch(users, name):
                    problems.append(f"{name}:{number}: <{included}> is slow to compile; only {users} may include it")


def check_links(project, problems):
    """Reports libraries of the project that a folder links but does not include."""
    for folder in sorted(TOP_FOLDERS):
        cmake = project / "core" / folder / "CMakeLists.txt"
        if not cmake.is_file():
            continue
        used = {included.split("/")[0] for path in sources(cmake.parent) for _, _, included in includes(path)}
        for linked in re.findall(r"\bstopline_(\w+)", cmake.read_text(encoding="utf-8")):
            if linked in TOP_FOLDERS and linked != folder and linked not in used:
                problems.append(f"core/{folder}/CMakeLists.txt: links stopline_{linked}, but no file of the folder includes it")


def check_cycles(project, problems):
    """Reports a cycle of includes between rooms."""
    edges = {}
    for path in sources(project / "core"):
        room = room_of(str(path.relative_to(project / "core")))
        for _, _, included in includes(path):
            if included.split("/")[0] in TOP_FOLDERS and room_of(included) != room:
                edges.setdefault(room, set()).add(room_of(included))
    state = {}

    def visit(room, trail):
        if state.get(room) == "done":
            return
        if room in trail:
            problems.append("the includes between rooms form a cycle: " + " -> ".join(trail[trail.index(room):] + [room]))
            return
        for target in sorted(edges.get(room, ())):
            visit(target, trail + [room])
        state[room] = "done"

    for room in sorted(edges):
        visit(room, [])


def check_sizes(project, files, problems):
    for path in files:
        lines = len(path.read_text(encoding="utf-8").splitlines())
        if lines > MAX_LINES:
            problems.append(f"{path.relative_to(project)}: {lines} lines; split the file, the limit is {MAX_LINES}")
    for folder in sorted({path.parent for path in files}):
        count = sum(1 for path in folder.iterdir() if path.is_file() and path.name != "CMakeLists.txt")
        if count > MAX_FILES:
            problems.append(f"{folder.relative_to(project)}: {count} files in one folder; the limit is {MAX_FILES}")


def main():
    project = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[2]).resolve()
    problems = []
    core_files = sources(project / "core")
    app_files = sources(project / "apps")
    if not core_files:
        problems.append(f"no sources under {project / 'core'}")

    for path in core_files:
        check_core_file(path, project, problems)
    check_heavy(core_files + app_files, project, problems)
    check_links(project, problems)
    check_cycles(project, problems)
    check_sizes(project, core_files + app_files, problems)

    for problem in problems:
        print(problem)
    print(f"{len(core_files) + len(app_files)} files checked, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
