// All tables of a scenario as text. Programs write them to files, and the Python module makes columns of them.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "runs/intersection/intersection.h"
#include "runs/network/network.h"
#include "runs/single_light/single_light.h"
#include "scenario/scenario.h"

namespace stopline {

using NamedText = std::pair<std::string, std::string>;  // file name and text of a table

// Returns the result tables of a report, except the trajectories. summary.csv is the first one.
std::vector<NamedText> result_tables(const SingleLightReport& report);
std::vector<NamedText> result_tables(const IntersectionReport& report);
std::vector<NamedText> result_tables(const NetworkReport& report);

// Name and final state hash of each population.
using StateHashes = std::vector<NamedText>;

std::string state_hash_text(std::uint64_t hash);

// Returns the state hashes of results such as NetworkReport::populations.
template <class Results>
StateHashes state_hashes(const Results& results) {
    StateHashes hashes;
    for (const auto& result : results) hashes.emplace_back(result.population, state_hash_text(result.state_hash));
    return hashes;
}

struct RunReport {
    std::vector<NamedText> tables;
    StateHashes state_hashes;
    bool passes = false;  // no violation has occurred, and no movement starves
};

// Runs all populations of a scenario in up to `threads` threads. `on_progress` gets the completed share, 0 .. 1, and
// returns false to stop. Throws Interrupted if it does.
RunReport run_report(const Scenario& scenario, int threads, const std::function<bool(double)>& on_progress = {});

}  // namespace stopline
