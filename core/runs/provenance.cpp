#include "runs/provenance.h"

#include <sstream>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "base/version.h"
#include "scenario/load_scenario.h"

namespace stopline {

namespace {

std::string text_of(const nlohmann::ordered_json& json) {
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace

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
    return text_of(json);
}

std::string table_provenance_json(const std::string& command, const std::string& file,
                                  const std::map<std::string, std::uint64_t>& scenario_hashes) {
    nlohmann::ordered_json json;
    json["program"] = "stopline";
    json["version"] = version();
    json["command"] = command;
    json["files"] = {file};
    json["scenario_hashes"] = nlohmann::ordered_json::object();
    for (const auto& [scenario, hash] : scenario_hashes)
        json["scenario_hashes"][scenario] = fmt::format("{:016x}", hash);
    return text_of(json);
}

}  // namespace stopline
