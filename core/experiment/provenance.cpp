#include "experiment/provenance.h"

#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/version.h"
#include "scenario/load_scenario.h"

namespace stopline {

std::string provenance_json(const Scenario& scenario, const Provenance& provenance) {
    nlohmann::ordered_json json;
    json["program"] = "stopline";
    json["version"] = version();
    json["command"] = provenance.command;
    json["scenario"] = scenario.name;
    json["scenario_hash"] = fmt::format("{:016x}", scenario.hash);
    json["seed"] = scenario.seed;
    json["files"] = provenance.files;
    json["state_hashes"] = nlohmann::ordered_json::object();
    for (const auto& [population, hash] : provenance.state_hashes) json["state_hashes"][population] = hash;
    json["parameters"] = nlohmann::ordered_json::array();
    std::istringstream lines(canonical_text(scenario));
    for (std::string line; std::getline(lines, line);) json["parameters"].push_back(line);
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace stopline
