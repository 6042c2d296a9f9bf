#!/usr/bin/env python3
"""Runs clang-tidy on the sources of core/ and apps/, in parallel, and caches which files are clean.

    lint.py BUILD [FILE...]

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
import subprocess
import sys
from pathlib import Path

PROJECT = Path(__file__).resolve().parents[2]
OWN_CLANG_TIDY = PROJECT / "build/clang-tidy/bin/clang-tidy"  # installed by tests/tools/install_clang_tidy.sh
CLANG_TIDY = str(OWN_CLANG_TIDY) if OWN_CLANG_TIDY.is_file() else "clang-tidy-14"
GCC_HEADERS = Path(subprocess.run(["g++", "-print-file-name=include/omp.h"], capture_output=True, text=True, check=True).stdout).parent
FOLDERS = ["core", "apps"]
INCLUDE_ROOTS = [PROJECT / "core", PROJECT / "apps"]
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


def lint(entry, build):
    command = [
        CLANG_TIDY,
        "--quiet",
        f"--config-file={PROJECT / '.clang-tidy'}",
        f"-p={build / 'lint'}",
        f"--header-filter=^{re.escape(str(PROJECT))}/({'|'.join(FOLDERS)})/",
        "--extra-arg=-Wno-unknown-warning-option",  # the compile commands are for gcc
        f"--extra-arg=-idirafter{GCC_HEADERS}",  # for omp.h
        "--extra-arg=-Wno-deprecated-declarations",  # for code of the standard library; gcc gives these warnings for our code
        entry["file"],
    ]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    return result.returncode == 0, result.stdout + (result.stderr if result.returncode != 0 else "")


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    build = Path(sys.argv[1]).resolve()
    database = build / "compile_commands.json"
    if not database.is_file():
        sys.exit(f"lint: {database} is missing; configure the build first")
    all_entries = [without_precompiled_header(entry) for entry in json.loads(database.read_text())]
    entries = {Path(entry["file"]).resolve(): entry for entry in all_entries}

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
    (cache / "compile_commands.json").write_text(json.dumps(all_entries))
    keys = {path: key(entries[path], tool) for path in sources if path in entries}
    to_do = [path for path in keys if not (cache / keys[path]).exists()]

    failed = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        runs = {pool.submit(lint, entries[path], build): path for path in to_do}
        for run in concurrent.futures.as_completed(runs):
            clean, output = run.result()
            if clean:
                (cache / keys[runs[run]]).touch()
            else:
                failed += 1
                print(output.strip(), flush=True)
    print(f"{len(sources)} files, {len(sources) - len(to_do) - len(missing)} clean from earlier runs, {failed} with findings")
    return 1 if failed or missing else 0


if __name__ == "__main__":
    sys.exit(main())
