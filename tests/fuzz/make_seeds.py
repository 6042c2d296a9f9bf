#!/usr/bin/env python3
"""Copies the first inputs of the fuzz targets into one folder for each target.

    make_seeds.py FOLDER

The script takes the scenarios, the sweeps and the SUMO files of the project, and the own seeds in corpus/. A file
corpus/TARGET.txt has one seed in each line; a folder corpus/TARGET has one seed in each file. Findings of campaigns are
kept there too.
The SUMO files are also packed with gzip.
"""

import gzip
import shutil
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
PROJECT = HERE.parents[1]
MAX_BYTES = 60_000  # larger files make the fuzzer slow


def project_files():
    """Yields (target, file) for each file of the project that is a seed."""
    scenarios = [*PROJECT.glob("scenarios/*.yaml"), *PROJECT.glob("tests/data/*.yaml")]
    for file in scenarios:
        yield ("streets" if "kind: streets" in file.read_text(encoding="utf-8") else "scenario"), file
    for file in PROJECT.glob("scenarios/sweeps/*.yaml"):
        yield "sweep", file
    for file in PROJECT.glob("tests/data/**/*.net.xml"):
        yield "sumo_net", file
    for file in PROJECT.glob("tests/data/*.rou.xml"):
        yield "sumo_routes", file
    for folder in HERE.glob("corpus/*/"):
        for file in folder.iterdir():
            yield folder.name, file


def main():
    seeds = Path(sys.argv[1])
    shutil.rmtree(seeds, ignore_errors=True)
    for target, file in project_files():
        content = file.read_bytes()
        if len(content) > MAX_BYTES:
            continue
        folder = seeds / target
        folder.mkdir(parents=True, exist_ok=True)
        (folder / file.name).write_bytes(content)
        if file.suffix == ".xml":
            (folder / f"{file.name}.gz").write_bytes(gzip.compress(content, mtime=0))
    for file in HERE.glob("corpus/*.txt"):
        folder = seeds / file.stem
        folder.mkdir(parents=True, exist_ok=True)
        for number, line in enumerate(file.read_text(encoding="utf-8").splitlines()):
            (folder / f"line_{number + 1}").write_text(line, encoding="utf-8")
    (seeds / "made").touch()


if __name__ == "__main__":
    main()
