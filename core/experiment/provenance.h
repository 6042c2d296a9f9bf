// Where results come from: which scenario, with which parameters, by which version and command. Kept in a side file beside
// the results, `<name>.provenance.json`. It holds no date and no path of the machine, so that the same run gives the same bytes.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "scenario/scenario.h"

namespace stopline {

struct Provenance {
    std::string command;                                            // that makes the results again
    std::vector<std::string> files;                                 // what it covers, by name
    std::vector<std::pair<std::string, std::string>> state_hashes;  // population and hash at the end of its run
};

// JSON text; the scenario appears with all its parameters as canonical YAML lines.
std::string provenance_json(const Scenario& scenario, const Provenance& provenance);

// The same for a table over several scenarios, given by name and hash.
std::string table_provenance_json(const std::string& command, const std::string& file,
                                  const std::map<std::string, std::uint64_t>& scenario_hashes);

}  // namespace stopline
