// A scenario that runs in a few milliseconds: twelve vehicles, three populations, 20 s of green.
#pragma once

#include <string>
#include <vector>

#include "scenario/load_scenario.h"

namespace stopline {

inline Scenario short_scenario(const std::vector<std::string>& overrides = {}) {
    constexpr const char* kText = R"(
duration: 100 s
network: {approach: {length: 200 m, exit_length: 800 m}}
signal: {first_green: 50 s, green: 20 s}
demand: {vehicles: 12}
populations:
- CDG
- {name: MIX, pattern: alternating, components: [{policy: CDG, share: 50 %}, {policy: CTG-Ref, share: 50 %}]}
- CTG-Ref
measure: {green: [5 s, 10 s, 15 s], baseline: CTG-Ref}
)";
    return parse_scenario(kText, "short.yaml", overrides);
}

}  // namespace stopline
