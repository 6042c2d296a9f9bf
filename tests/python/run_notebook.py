#!/usr/bin/env python3
"""Executes the code cells of a notebook in order, without Jupyter, and fails if a cell raises or no figure is drawn.

    run_notebook.py FOLDER_OF_THE_PACKAGE NOTEBOOK
"""

import json
import os
import sys
from pathlib import Path

try:
    import matplotlib
except ImportError:
    sys.exit(77)
matplotlib.use("agg")

package, notebook = (Path(argument).resolve() for argument in sys.argv[1:3])
sys.path.insert(0, str(package))
os.chdir(notebook.parent)
cells = [cell for cell in json.loads(notebook.read_text())["cells"] if cell["cell_type"] == "code"]
names = {}
for number, cell in enumerate(cells, start=1):
    source = "".join(cell["source"])
    if cell["outputs"]:
        sys.exit(f"{notebook.name}, code cell {number}: clear the outputs before you commit the notebook")
    exec(compile(source, f"{notebook.name}, code cell {number}", "exec"), names)

import matplotlib.pyplot as plt  # noqa: E402

if not plt.get_fignums():
    sys.exit(f"{notebook.name} draws no figure")
if folder := os.environ.get("STOPLINE_NOTEBOOK_FIGURES"):
    for number in plt.get_fignums():
        plt.figure(number).savefig(Path(folder) / f"{notebook.stem}_{number}.png", dpi=100)
