"""Stopline, a traffic microsimulator of signalised streets, in Python.

A run of a scenario in the background, with its tables:

    import stopline
    run = stopline.start("scenarios/single_light.yaml", {"signal.green": "20 s"})
    run.wait()
    summary = run.tables["summary"]
    print(summary["population"], summary["vehicles_in_20_s"])

A simulation step by step:

    simulation = stopline.Simulation("scenarios/single_light.yaml", population="CDG")
    while simulation.time_s < 300.0:
        simulation.step()
    vehicles = simulation.vehicles()     # a dictionary of NumPy arrays
"""

import os as _os
from pathlib import Path as _Path

# An installed package carries the data of the project. A package in the build folder uses those of the source tree.
_data = _Path(__file__).parent / "data"
if _data.is_dir():
    _os.environ.setdefault("STOPLINE_DATA", str(_data))

from ._core import InputError, Run, Scenario, Simulation as _Simulation, Table, version  # noqa: E402

__version__ = version()
__all__ = ["InputError", "Run", "Scenario", "Simulation", "Table", "load", "run", "start"]


def load(file, settings=None):
    """Loads a scenario file. `settings`: fields with their values as text, as for `stopline-run --set`, for instance
    {"signal.green": "20 s", "populations": "[CDG, CTG-Ref]"}. Numbers may be given as numbers. Errors in the file or in
    the settings raise InputError."""
    texts = [f"{field}={value}" for field, value in (settings or {}).items()]
    return Scenario(_os.fspath(file), texts)


def start(scenario, settings=None, threads=0):
    """Starts the runs of all populations of a scenario in the background and returns a Run at once. `scenario`: a
    Scenario or the name of a file. `threads`: number of threads; 0: all processors. Results do not depend on it."""
    if not isinstance(scenario, Scenario):
        scenario = load(scenario, settings)
    elif settings:
        raise ValueError("give settings to load(), because the scenario is loaded already")
    return Run(scenario, threads)


def run(scenario, settings=None, threads=0):
    """Runs all populations of a scenario, waits for the end, and returns the tables by name."""
    return start(scenario, settings, threads).wait().tables


class Simulation(_Simulation):
    """A simulation of one population, step by step. `scenario`: a Scenario or the name of a file. `population`: name or
    index; default: the first one."""

    def __init__(self, scenario, settings=None, population=0, threads=1):
        if not isinstance(scenario, Scenario):
            scenario = load(scenario, settings)
        elif settings:
            raise ValueError("give settings to load(), because the scenario is loaded already")
        if isinstance(population, str):
            if population not in scenario.populations:
                raise ValueError(f"there is no population {population!r}; the populations are {scenario.populations}")
            population = scenario.populations.index(population)
        super().__init__(scenario, population, threads)
