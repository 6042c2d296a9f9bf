// A scenario with demand by rate, for tests of signal timing.
#pragma once

#include <string>
#include <vector>

#include "scenario/load_scenario.h"

namespace stopline {

constexpr const char* kTimedIntersection = R"(
network:
  kind: intersection
  intersection: {lanes: [{movements: straight+left}, {movements: straight+right}], approach_length: 155 m}
signal: {first_green: 1 s, green: 15 s}
demand: {kind: rate, inflow: 900 veh/h}
duration: 0 s
populations: [CTG-Ref]
)";

inline Scenario timed_intersection(const std::vector<std::string>& overrides = {}) {
    return parse_scenario(kTimedIntersection, "timed.yaml", overrides);
}

}  // namespace stopline
