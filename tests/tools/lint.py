#!/usr/bin/env python3
"""Runs clang-tidy on the sources of core/ and apps/, in parallel, and caches which files are clean.

    lint.py BUILD [FILE...]

Most of the time goes into the headers of libraries. Up to BATCH files with equal compile commands are therefore checked as
one file that includes them. If such a batch has findings, its halves are checked in the same way.

BUILD is a configured build directory with compile_commands.json. With FILEs, only these are checked. A clean file is
checked again only after a change of its text, of a project header that it includes, of its compile command, of
.clang-tidy or of clang-tidy.

Uses the clang-tidy of install_clang_tidy.sh if it is installed, otherwise Debian's, which takes three times as long.
"""

import concurrent.futures
import hashlib
import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
OWN_CLANG_TIDY = PROJECT / "build/clang-tidy/bin/clang-tidy"  # installed by tests/tools/install_clang_tidy.sh
CLANG_TIDY = str(OWN_CLANG_TIDY) if OWN_CLANG_TIDY.is_file() else "clang-tidy-14"
GCC_HEADERS = Path(subprocess.run(["g++", "-print-file-name=include/omp.h"], capture_output=True, text=True, check=True).stdout).parent
FOLDERS = ["core", "apps"]
INCLUDE_ROOTS = [PROJECT / "core", PROJECT / "apps"]
BATCH = 16
# Names at the start of a line: functions, types and constants that must not occur twice in a batch.
LOCAL_NAME = re.compile(
    r"^(?:(?:struct|class|enum(?: class)?|using)\s+(\w+)"
    r"|(?:[A-Za-z_][\w:<>,&*\s]*?[\s&*])(\w+)\s*[({=\[;])", re.MULTILINE)
UNITY_SOURCE = re.compile(r"unity_\d+_cxx\.cxx")
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.MULTILINE)


def text_with_headers(path, visited):
    """Returns the text of a file and of all project headers that it includes, directly or indirectly."""
    if path in visited:
        return b""
    visited.add(path)
    text = path.read_bytes()
    for included in INCLUDE.findall(text.decode("utf-8", "replace")):
        for root in [path.parent, *INCLUDE_ROOTS]:
            header = (root / included).resolve()
            if header.is_file():
                text += text_with_headers(header, visited)
                break
    return text


def key(entry, tool):
    """Returns a hash of everything that can change the result for a file."""
    digest = hashlib.sha256(tool)
    digest.update((entry.get("command") or " ".join(entry["arguments"])).encode())
    digest.update(text_with_headers(Path(entry["file"]), set()))
    return digest.hexdigest()


def without_precompiled_header(entry):
    """Returns the entry without gcc's precompiled header. Each file must name the headers that it needs."""
    command = re.sub(r"-Winvalid-pch ", "", entry["command"])
    return {**entry, "command": re.sub(r"-include \S*cmake_pch\.hxx ", "", command)}


def entries_of_sources(entry):
    """Returns the entry in a list. For a unity source of CMake, returns one entry for each project source in it."""
    path = Path(entry["file"])
    if not UNITY_SOURCE.fullmatch(path.name):
        return [entry]
    command = re.sub(r" -o \S+ -c \S+$", "", entry["command"])
    return [{**entry, "file": source, "command": f"{command} -o {source}.o -c {source}"}
            for source in INCLUDE.findall(path.read_text(encoding="utf-8"))]


def flags_of(entry):
    """Returns the arguments of the compiler, without files and optimisation level."""
    return re.sub(r" -o \S+ -c \S+$| -O[0-3]\b", "", entry["command"]).split(" ", 1)[1]


def batches(paths, entries):
    """Returns lists of files that can be compiled as one: equal flags and no common local names."""
    lists = []
    open_lists = {}  # by flags: pairs of a list and the names in its files
    for path in paths:
        text = path.read_text(encoding="utf-8")
        names = {name for match in LOCAL_NAME.findall(text) for name in match if name not in ("", "stopline")}
        candidates = open_lists.setdefault(flags_of(entries[path]), [])
        for files, used in candidates:
            if len(files) < BATCH and not names & used:
                files.append(path)
                used |= names
                break
        else:
            candidates.append(([path], names))
            lists.append(candidates[-1][0])
    return lists


def lint(source, flags, directory):
    """Runs clang-tidy on a source file. Returns true if the file is clean, and the output."""
    command = [
        CLANG_TIDY,
        "--quiet",
        f"--config-file={PROJECT / '.clang-tidy'}",
        f"--header-filter=^{re.escape(str(PROJECT))}/({'|'.join(FOLDERS)})/",
        "--extra-arg=-Wno-unknown-warning-option",  # the compile commands are for gcc
        f"--extra-arg=-idirafter{GCC_HEADERS}",  # for omp.h
        "--extra-arg=-Wno-deprecated-declarations",  # for code of the standard library; gcc gives these warnings for our code
        "--checks=-bugprone-suspicious-include",  # a batch includes source files on purpose
        source,
        "--",
        *shlex.split(flags),
    ]
    result = subprocess.run(command, capture_output=True, text=True, check=False, cwd=directory)
    return result.returncode == 0, result.stdout + (result.stderr if result.returncode != 0 else "")


def findings(files, entries, cache):
    """Checks files with equal flags. Returns the files that have findings, with the output of clang-tidy."""
    entry = entries[files[0]]
    flags, directory = flags_of(entry), entry["directory"]
    if len(files) == 1:
        clean, output = lint(files[0], flags, directory)
        return {} if clean else {files[0]: output}
    batch = cache / f"batch_{hashlib.sha256(str(files).encode()).hexdigest()[:16]}.cpp"
    batch.write_text("".join(f'#include "{path}"\n' for path in files))
    clean, _ = lint(batch, flags, directory)
    batch.unlink()
    if clean:
        return {}
    half = len(files) // 2
    return findings(files[:half], entries, cache) | findings(files[half:], entries, cache)


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    build = Path(sys.argv[1]).resolve()
    database = build / "compile_commands.json"
    if not database.is_file():
        sys.exit(f"lint: {database} is missing; configure the build first")
    entries = {
        Path(entry["file"]).resolve(): entry
        for listed in json.loads(database.read_text())
        for entry in entries_of_sources(without_precompiled_header(listed))
    }

    sources = sorted(path for folder in FOLDERS for path in (PROJECT / folder).rglob("*.cpp"))
    if len(sys.argv) > 2:
        sources = [Path(name).resolve() for name in sys.argv[2:]]
    missing = [path for path in sources if path not in entries]
    for path in missing:
        print(f"{path}: no target builds this file, or it is newer than the last build")

    version = subprocess.run([CLANG_TIDY, "--version"], capture_output=True, check=True).stdout
    tool = version + (PROJECT / ".clang-tidy").read_bytes() + Path(__file__).read_bytes()
    cache = build / "lint"
    cache.mkdir(exist_ok=True)
    keys = {path: key(entries[path], tool) for path in sources if path in entries}
    to_do = [path for path in keys if not (cache / keys[path]).exists()]
    lists = batches(to_do, entries)
    failed = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for files, found in zip(lists, pool.map(lambda files: findings(files, entries, cache), lists)):
            failed += len(found)
            for path in files:
                if path not in found:
                    (cache / keys[path]).touch()
            for output in found.values():
                print(output.strip(), flush=True)
    print(f"{len(sources)} files, {len(sources) - len(to_do) - len(missing)} clean from earlier runs, {failed} with findings")
    return 1 if failed or missing else 0


if __name__ == "__main__":
    sys.exit(main())
