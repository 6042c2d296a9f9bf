#!/usr/bin/env python3
"""Checks that includes go one way, and that files stay short.

    check_includes.py [PROJECT]

Reads every #include "..." of core/ and apps/ under PROJECT (default: the project this script lies in). Fails when a folder
of core/ includes one that it may not know, when yaml-cpp appears in more than one source file or outside core/scenario, when
an include does not name a file from the include root, and when a file is longer than MAX_LINES.
"""

import re
import sys
from pathlib import Path

# What each folder of core/ may include besides itself. `measure` sees events and the network but never a vehicle or a driver,
# so that metrics cannot depend on the fidelity; `vehicle` and `driver` never see each other.
ALLOWED = {
    "base": [],
    "network": ["base"],
    "vehicle": ["base"],
    "driver": ["base"],
    "signals": ["base", "network"],
    "demand": ["base", "network"],
    "sim": ["base", "network", "signals", "demand", "vehicle", "driver"],
    "measure": ["base", "network", "sim"],
    "record": ["base", "network", "signals", "sim"],
    "scenario": ["base", "network", "signals", "demand", "vehicle", "driver", "sim", "measure"],
    "experiment": ["base", "sim", "measure", "scenario"],
    "report": ["base", "scenario", "experiment"],
    "sumo": ["base", "network", "signals", "sim", "measure", "record", "scenario", "experiment"],
}
YAML_FOLDER = "scenario"
MAX_LINES = 450
SUFFIXES = {".h", ".hpp", ".cpp", ".cc", ".cxx", ".c", ".inl", ".inc", ".ipp"}

INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def sources(folder):
    return sorted(path for path in folder.rglob("*") if path.is_file() and path.suffix in SUFFIXES)


def includes(path):
    """(line number, '<' or '"', included path) of each include of a file."""
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if match:
            yield number, match.group(1), match.group(2)


def check_core_file(path, project, problems):
    folder = path.relative_to(project / "core").parts[0]
    allowed = [folder] + ALLOWED[folder]
    for number, quote, included in includes(path):
        where = f"{path.relative_to(project)}:{number}"
        target = included.split("/")[0]
        if "/" in included and target in ALLOWED:
            if quote == "<":
                problems.append(f'{where}: write "{included}", as for every file of the project')
            elif not (project / "core" / included).is_file():
                problems.append(f"{where}: there is no core/{included}")
            if target not in allowed:
                problems.append(f"{where}: {folder} must not include {included}; it may include {', '.join(allowed)}")
        elif quote == '"' and included != "version_text.h":
            problems.append(f'{where}: "{included}" does not begin with a folder of core/ ({", ".join(ALLOWED)})')


def check_yaml(files, project, problems):
    users = [path for path in files if any(included.startswith("yaml-cpp/") for _, _, included in includes(path))]
    names = ", ".join(str(path.relative_to(project)) for path in users)
    if len(users) > 1:
        problems.append(f"yaml-cpp belongs in one source file, but is included by {names}")
    for path in users:
        if path.suffix != ".cpp" or path.parent != project / "core" / YAML_FOLDER:
            problems.append(f"{path.relative_to(project)}: yaml-cpp belongs in one .cpp of core/{YAML_FOLDER}")


def main():
    project = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[2]).resolve()
    problems = []
    core_files = sources(project / "core")
    app_files = sources(project / "apps")
    if not core_files:
        problems.append(f"no sources under {project / 'core'}")

    for path in core_files:
        folder = path.relative_to(project / "core").parts[0]
        if folder in ALLOWED:
            check_core_file(path, project, problems)
        else:
            problems.append(f"{path.relative_to(project)}: core/{folder} is not a known folder; add it to {Path(__file__).name}")
    check_yaml(core_files + app_files, project, problems)
    for path in core_files + app_files:
        lines = len(path.read_text(encoding="utf-8").splitlines())
        if lines > MAX_LINES:
            problems.append(f"{path.relative_to(project)}: {lines} lines; split it, {MAX_LINES} is the limit")

    for problem in problems:
        print(problem)
    print(f"{len(core_files) + len(app_files)} files checked, {len(problems)} problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
