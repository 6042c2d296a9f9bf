// Provenance of results: scenario, parameters, program version and command. Programs write it as NAME.provenance.json
// into the folder of the results. It contains no date and no path of the machine, so the same run gives the same bytes.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenario/scenario.h"

namespace stopline {

struct Provenance {
    std::string command;                                            // command line that reproduces the results
    std::vector<std::string> files;                                 // names of the result files
    std::vector<std::pair<std::string, std::string>> state_hashes;  // population and hash of its final state
};

// Returns the provenance as JSON text. It contains all parameters of the scenario, one line for each parameter.
std::string provenance_json(const Scenario& scenario, const Provenance& provenance);

// Returns the provenance of a table with results of several scenarios as JSON text. `scenario_hashes` maps the name of
// each scenario to its hash.
std::string table_provenance_json(const std::string& command, const std::string& file,
                                  const std::map<std::string, std::uint64_t>& scenario_hashes);

}  // namespace stopline
