#!/usr/bin/env python3
"""Tests the Python module stopline.

    module_test.py FOLDER_OF_THE_PACKAGE FOLDER_OF_STOPLINE_PROGRAMS
"""

import json
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

try:
    import numpy as np
except ImportError:
    sys.exit(77)

SOURCE = Path(__file__).resolve().parents[2]
PACKAGE, PROGRAMS = (Path(argument).resolve() for argument in sys.argv[1:3])
sys.path.insert(0, str(PACKAGE))
import stopline  # noqa: E402

SCENARIOS = SOURCE / "scenarios"
SHORT_QUEUE = {"populations": "[CDG, CTG-Ref]", "demand.vehicles": 10, "signal.first_green": "60 s", "duration": "130 s"}


def single_light(**more):
    return stopline.load(SCENARIOS / "single_light.yaml", SHORT_QUEUE | more)


class Runs(unittest.TestCase):
    def test_a_run_gives_the_tables_and_bits_of_the_program(self):
        run = stopline.start(single_light()).wait()
        with tempfile.TemporaryDirectory() as folder:
            settings = [word for field, value in SHORT_QUEUE.items() for word in ("--set", f"{field}={value}")]
            subprocess.run([PROGRAMS / "stopline-run", SCENARIOS / "single_light.yaml", *settings, "--no-figures",
                            "--output", folder], check=True, capture_output=True)
            provenance = json.loads((Path(folder) / "single_light.provenance.json").read_text())
            header, *rows = (Path(folder) / "summary.csv").read_text().splitlines()
        hashes = {entry["population"]: entry["state_hash"] for entry in provenance["state_hashes"]} \
            if isinstance(provenance["state_hashes"], list) else provenance["state_hashes"]
        self.assertEqual(run.state_hashes, hashes)
        summary = run.tables["summary"]
        self.assertEqual(summary.columns, header.split(","))
        self.assertEqual(len(summary), len(rows))
        for k, row in enumerate(rows):
            for name, cell in zip(summary.columns, row.split(",")):
                value = summary[name][k]
                self.assertTrue(value == cell if isinstance(value, str) else
                                (np.isnan(value) if cell == "" else value == float(cell)), f"{name}: {value} and {cell}")

    def test_columns_share_the_memory_of_the_table(self):
        tables = stopline.run(single_light())
        first, second = tables["passages"]["time_s"], tables["passages"]["time_s"]
        self.assertTrue(np.shares_memory(first, second))
        self.assertFalse(first.flags.writeable)
        del tables
        self.assertTrue(np.isfinite(first).all(), "the column keeps the table alive")

    def test_other_threads_run_meanwhile(self):
        run = stopline.start(SCENARIOS / "grid.yaml", {"duration": "3000 s", "measure.window": "1000 s"}, threads=1)
        ticks = []
        ticker = threading.Thread(target=lambda: [ticks.append(time.sleep(0.001)) for _ in range(50)])
        ticker.start()
        simulation = stopline.Simulation(single_light())
        simulation.run_until(130.0)  # releases the lock of the interpreter
        ticker.join()
        self.assertEqual(len(ticks), 50)
        self.assertLess(run.progress, 1.0)
        run.cancel()
        with self.assertRaisesRegex(RuntimeError, "cancelled"):
            run.wait()

    def test_errors_say_where_they_are(self):
        with self.assertRaisesRegex(stopline.InputError, "signal.gren.*did you mean 'green'"):
            single_light(**{"signal.gren": "20 s"})
        with self.assertRaisesRegex(stopline.InputError, "nowhere.yaml"):
            stopline.load("nowhere.yaml")
        with self.assertRaisesRegex(KeyError, "the columns of summary are"):
            stopline.run(single_light())["summary"]["speed"]
        with self.assertRaisesRegex(ValueError, "the populations are"):
            stopline.Simulation(single_light(), population="CDG-9m")


class Steps(unittest.TestCase):
    def test_steps_give_the_bits_of_the_run(self):
        for file, settings, end_s in (("single_light.yaml", SHORT_QUEUE, 130.0),
                                      ("grid.yaml", {"duration": "60 s", "measure.window": "30 s"}, 60.0)):
            scenario = stopline.load(SCENARIOS / file, settings)
            hashes = stopline.start(scenario).state_hashes
            for population in scenario.populations:
                simulation = stopline.Simulation(scenario, population=population)
                while simulation.time_s < end_s - 1e-9:
                    simulation.step()
                    if simulation.time_s % 10.0 < simulation.step_s:
                        simulation.vehicles()  # reading changes nothing
                self.assertEqual(simulation.state_hash, hashes[population], f"{file}, {population}")

    def test_the_arrays_agree_with_each_other(self):
        simulation = stopline.Simulation(single_light())
        simulation.run_until(75.0)
        vehicles = simulation.vehicles()
        self.assertEqual(len(vehicles["id"]), simulation.entered - simulation.exited)
        on_approach = vehicles["lane"] == simulation.lanes.index("approach_0")
        position, length, gap = (vehicles[name][on_approach] for name in ("position_m", "length_m", "gap_m"))
        np.testing.assert_allclose(gap[1:], position[:-1] - length[:-1] - position[1:], atol=1e-9)
        self.assertTrue((np.diff(vehicles["id"][on_approach]) == 1).all())
        np.testing.assert_array_equal(vehicles["leader_id"][on_approach][1:], vehicles["id"][on_approach][:-1])

    def test_a_policy_can_change(self):
        scenario = single_light(populations="[{name: both, pattern: alternating, components: "
                                            "[{policy: CDG, share: 50 %}, {policy: CTG-Ref, share: 50 %}]}]",
                                **{"measure.baseline": "both"})
        gaps = {}
        for policy in ("CDG", "CTG-Ref"):
            simulation = stopline.Simulation(scenario)
            simulation.run_until(55.0)
            self.assertEqual(simulation.set_policy(simulation.vehicles()["id"], policy), 10)
            simulation.run_until(110.0)
            gaps[policy] = np.nanmean(simulation.vehicles()["gap_m"])
            self.assertEqual(simulation.violations["overlaps"], 0)
        self.assertAlmostEqual(gaps["CDG"], 2.95, delta=0.1)
        self.assertAlmostEqual(gaps["CTG-Ref"], 2.95 + 0.87 * 50 / 3.6, delta=0.5)
        with self.assertRaisesRegex(ValueError, "its policies are: CDG, CTG-Ref"):
            simulation.set_policy([0], "CDG-6m")

    def test_one_thread_at_a_time_uses_a_simulation(self):
        simulation = stopline.Simulation(SCENARIOS / "grid.yaml", {"duration": "3000 s", "measure.window": "1000 s"})
        runner = threading.Thread(target=simulation.run_until, args=(600.0,))
        runner.start()
        refused = 0
        while runner.is_alive():
            try:
                simulation.vehicles()
            except RuntimeError:
                refused += 1
            time.sleep(0.001)
        runner.join()
        self.assertGreater(refused, 0)
        self.assertEqual(simulation.violations["overlaps"], 0)

    def test_wrong_commands_are_refused(self):
        for threads in (-1, 0, 2000):
            with self.assertRaisesRegex(ValueError, "threads"):
                stopline.Simulation(single_light(), threads=threads)
        with self.assertRaisesRegex(ValueError, "threads"):
            stopline.run(single_light(), threads=100_000)
        simulation = stopline.Simulation(single_light())
        simulation.run_until(30.0)
        with self.assertRaisesRegex(ValueError, "has not entered"):
            simulation.set_acceleration([1000], [1.0])
        with self.assertRaisesRegex(ValueError, "2 vehicles, but 1 accelerations"):
            simulation.set_acceleration([0, 1], [1.0])
        for ids in ([0.5], ["3"], [True], [2**40]):
            with self.assertRaisesRegex(ValueError, "vehicle"):
                simulation.set_acceleration(ids, [1.0])
        with self.assertRaisesRegex(ValueError, "no policy"):
            simulation.set_policy([], "CDG-9m")
        with self.assertRaisesRegex(ValueError, "0 or more"):
            simulation.step(-1)
        with self.assertRaisesRegex(ValueError, "at most"):
            simulation.run_until(float("nan"))
        with self.assertRaisesRegex(ValueError, "controller 'external'"):
            simulation.set_phase(0, 0)
        meso = stopline.Simulation(single_light(fidelity="meso"))
        meso.run_until(30.0)
        with self.assertRaisesRegex(ValueError, "mesoscale"):
            meso.set_acceleration([0], [1.0])


class OwnSignal(unittest.TestCase):
    def test_pedestrian_phases_last_for_their_green(self):
        simulation = stopline.Simulation(SCENARIOS / "phases.yaml", {"signal.controller": "external"})
        simulation.set_phase(0, 2)
        while simulation.phases != [2]:
            simulation.step()
        start_s = simulation.time_s
        simulation.set_phase(0, 3)
        while simulation.phases != [3]:
            simulation.step()
        self.assertAlmostEqual(simulation.time_s - start_s, 10.0 + 2.0, delta=0.15)

    def test_a_program_chooses_the_phases(self):
        simulation = stopline.Simulation(SCENARIOS / "phases.yaml", {"signal.controller": "external",
                                                                     "signal.phases[0].min_green": "5 s"})
        simulation.run_until(3.0)
        self.assertEqual(simulation.phases, [0])
        simulation.set_phase(0, 3)
        simulation.run_until(5.5)
        self.assertEqual(simulation.phases, [0], "the minimum of the green has not passed")
        simulation.run_until(1.0 + 5.0 + 3.0 + 1.0 + 0.2)
        self.assertEqual(simulation.phases, [3], "green, yellow and red have passed")
        for _ in range(10):
            simulation.run_until(simulation.time_s + 30.0)
            simulation.set_phase(0, 1 if simulation.phases == [3] else 3)
        self.assertGreater(simulation.exited, 50)
        self.assertEqual(set(simulation.violations.values()), {0})
        with self.assertRaisesRegex(ValueError, "phases 0 to 3"):
            simulation.set_phase(0, 4)


class OwnController(unittest.TestCase):
    """A controller in Python that follows the law of CTG-Ref."""

    STANDSTILL_M, TIME_GAP_S = 2.95, 0.87
    KP_1PS2, KD_1PS = 0.2, 0.7

    def acceleration(self, vehicles):
        """Keeps the gap standstill + time gap x speed: a proportional-derivative law with the acceleration of the leader."""
        speed, gap = vehicles["speed_mps"], vehicles["gap_m"]
        error_m = gap - self.STANDSTILL_M - self.TIME_GAP_S * speed
        closing_mps = vehicles["leader_speed_mps"] - speed
        rate_mps = closing_mps - self.TIME_GAP_S * vehicles["acceleration_mps2"]
        return vehicles["leader_acceleration_mps2"] + self.KP_1PS2 * error_m + self.KD_1PS * rate_mps

    def gaps_after(self, time_s, population, is_own):
        simulation = stopline.Simulation(single_light(), population=population)
        simulation.run_until(60.0)
        while simulation.time_s < time_s - 1e-9:
            if is_own:
                vehicles = simulation.vehicles()
                follows = vehicles["leader_id"] >= 0
                simulation.set_acceleration(vehicles["id"][follows], self.acceleration(vehicles)[follows])
            simulation.step()
        self.assertEqual(simulation.violations["overlaps"], 0)
        return simulation.vehicles()["gap_m"][1:]

    def test_no_acceleration_makes_vehicles_collide(self):
        for acceleration in (0.5, 3.0, 1e30, float("inf"), -1.0):
            simulation = stopline.Simulation(SCENARIOS / "intersection.yaml",
                                             {"populations": "[CDG]", "measure.baseline": "CDG", "measure.cycles": 1})
            for _ in range(60):
                ids = simulation.vehicles()["id"]
                simulation.set_acceleration(ids, np.full(len(ids), acceleration))
                simulation.step(100)
            self.assertEqual(set(simulation.violations.values()), {0}, f"{acceleration} m/s2")

    def test_it_keeps_the_gaps_of_ctg_ref(self):
        end_s = 120.0
        own = self.gaps_after(end_s, "CDG", True)
        reference = self.gaps_after(end_s, "CTG-Ref", False)
        others = self.gaps_after(end_s, "CDG", False)
        self.assertEqual(len(own), 9)
        np.testing.assert_allclose(own, reference, rtol=0.01)
        self.assertLess(others.max(), 4.0, "without the controller the vehicles keep the gap of CDG")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
