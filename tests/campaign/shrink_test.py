#!/usr/bin/env python3
"""Tests of shrink.py, without simulations."""

import unittest

import shrink


class Shrinking(unittest.TestCase):
    def test_keeps_only_what_the_failure_needs(self):
        case = {
            "scenario": {
                "seed": 7,
                "network": {"kind": "grid", "grid": {"columns": 3, "rows": 2}},
                "signal": {"green": "37.5 s", "yellow": "3 s"},
                "populations": [{"name": "X", "components": [
                    {"policy": "CDG", "share": "34 %"}, {"policy": "CTG-Ref", "share": "66 %"}]}],
            },
            "files": {},
        }  # fmt: skip

        def still_fails(smaller):
            scenario = smaller["scenario"]
            green = scenario.get("signal", {}).get("green", "0 s")
            populations = scenario.get("populations", [])
            components = [one for population in populations for one in population.get("components", [])]
            policies = [component.get("policy") for component in components]
            return float(green.split()[0]) >= 10 and "CTG-Ref" in policies

        result = shrink.shrunk(case, still_fails)["scenario"]
        self.assertEqual(set(result), {"signal", "populations"})
        self.assertEqual(set(result["signal"]), {"green"})
        self.assertLess(float(result["signal"]["green"].split()[0]), 20)
        self.assertEqual(result["populations"][0]["components"], [{"policy": "CTG-Ref", "share": "100 %"}])

    def test_keeps_the_shares_of_components(self):
        components = [{"policy": policy, "share": share} for policy, share in
                      (("CDG", "34 %"), ("CTG-Ref", "33 %"), ("SWITCH-1", "33 %"))]  # fmt: skip
        case = {"scenario": {"populations": [{"name": "X", "components": components}]}, "files": {}}

        def still_fails(smaller):
            populations = smaller["scenario"].get("populations", [])
            policies = [one.get("policy") for population in populations for one in population.get("components", [])]
            return "CDG" in policies and "SWITCH-1" in policies

        result = shrink.shrunk(case, still_fails)["scenario"]
        self.assertEqual(
            result["populations"][0]["components"],
            [{"policy": "CDG", "share": "67 %"}, {"policy": "SWITCH-1", "share": "33 %"}],
        )

    def test_leaves_out_lines_of_route_files(self):
        lines = [f'<trip id="{k}"/>' for k in range(20)]
        case = {"scenario": {}, "files": {"a.rou.xml": "\n".join(["<routes>", *lines, "</routes>"]) + "\n"}}
        result = shrink.shrunk(case, lambda smaller: 'id="13"' in smaller["files"]["a.rou.xml"])
        self.assertEqual(result["files"]["a.rou.xml"], '<routes>\n<trip id="13"/>\n</routes>\n')

    def test_stops_after_the_largest_number_of_runs(self):
        calls = []
        case = {"scenario": {f"field_{k}": k for k in range(50)}, "files": {}}
        shrink.shrunk(case, lambda smaller: bool(calls.append(1)), most_runs=10)
        self.assertEqual(len(calls), 10)


if __name__ == "__main__":
    unittest.main()
