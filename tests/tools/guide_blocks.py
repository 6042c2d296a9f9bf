#!/usr/bin/env python3
"""Extracts the tested blocks of a guide.

    guide_blocks.py GUIDE.md FOLDER BLOCKS

A comment on the line before a fenced block marks it. Both can be indented alike, in a list:
    <!-- file: NAME -->          the block is written to FOLDER/NAME
    <!-- tested -->              the shell block is a test
    <!-- tested: PROGRAM -->     the same, only where PROGRAM is installed
Each shell block is written to a file in BLOCKS. The output has one line for each shell block: the name of this file,
the line of the block in the guide, and PROGRAM.
"""

import re
import sys
from pathlib import Path

MARK = re.compile(r"( *)<!-- (file|tested)(?:: (\S+))? -->\s*$")
FENCE = re.compile(r" *```(\w*)\s*$")


def blocks_of(text, guide):
    """Yields kind, argument, line and text of each marked block."""
    lines = text.splitlines()
    number = 0
    while number < len(lines):
        mark = MARK.match(lines[number])
        if mark is None:
            if re.match(r"\s*<!--\s*(file|tested)", lines[number]):
                sys.exit(f"{guide}:{number + 1}: the mark '{lines[number].strip()}' has an unknown form")
            number += 1
            continue
        indent, kind, argument = mark.groups()
        fence = FENCE.match(lines[number + 1]) if number + 1 < len(lines) else None
        if fence is None or (kind == "file" and not argument) or (kind == "tested" and fence[1] != "sh"):
            sys.exit(f"{guide}:{number + 1}: a block ```sh must follow 'tested', and 'file' needs a name and a block")
        try:
            end = lines.index(indent + "```", number + 2)
        except ValueError:
            sys.exit(f"{guide}:{number + 2}: the block has no end")
        yield kind, argument, number + 2, "".join(line.removeprefix(indent) + "\n" for line in lines[number + 2:end])
        number = end + 1


def main():
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    guide, folder, blocks = (Path(argument) for argument in sys.argv[1:])
    for kind, argument, line, text in blocks_of(guide.read_text(encoding="utf-8"), guide):
        if kind == "file":
            file = folder / argument
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text, encoding="utf-8")
        else:
            file = blocks / f"line_{line}.sh"
            file.write_text(text, encoding="utf-8")
            print(file, line, argument or "")


if __name__ == "__main__":
    main()
