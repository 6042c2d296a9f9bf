// Provenance of results: scenario, parameters, program version and command. It is written beside the results as
// NAME.provenance.json. It contains no date and no path of the machine, so the same run gives the same bytes.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenario/scenario.h"

namespace stopline {

struct Provenance {
    std::string command;                                            // command that makes the results again
    std::vector<std::string> files;                                 // names of the result files
    std::vector<std::pair<std::string, std::string>> state_hashes;  // population, state hash at the end of its run
};

// Returns the provenance as JSON text. It contains all parameters of the scenario as canonical YAML lines.
std::string provenance_json(const Scenario& scenario, const Provenance& provenance);

// Returns the provenance of a table over several scenarios. `scenario_hashes` maps their names to their hashes.
std::string table_provenance_json(const std::string& command, const std::string& file,
                                  const std::map<std::string, std::uint64_t>& scenario_hashes);

}  // namespace stopline
