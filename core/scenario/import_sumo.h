// Reads the SUMO files of a scenario when the scenario is loaded.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "scenario/scenario.h"

namespace stopline {

struct DemandPlan;

// The path of a scenario field, and the error in it.
using FieldProblem = std::pair<std::string, std::string>;

// Returns an entry for each SUMO file that does not exist or cannot be read. Relative paths start at `directory`.
std::vector<FieldProblem> sumo_file_problems(const Scenario& scenario, const std::filesystem::path& directory);

// Reads network, additional and route files into the scenario. Does nothing for other network kinds. Throws InputError
// with file and line.
void import_sumo(Scenario& scenario, const std::filesystem::path& directory);

// Adds the imported trips to the demand plan, and draws their policies from the population of the plan.
void add_sumo_trips(const Scenario& scenario, DemandPlan& plan);

// An imported induction loop on a lane of the graph.
struct SumoLoopPlace {
    std::string name;
    int lane = -1;
    double position_m = 0.0;
};
std::vector<SumoLoopPlace> sumo_loops(const Scenario& scenario);

// Returns one line per ignored part of the files: "city.net.xml:12: ...".
std::vector<std::string> sumo_warnings(const Scenario& scenario);

// Returns an error if the files have no vehicle, trip or flow.
std::vector<FieldProblem> sumo_demand_problems(const Scenario& scenario);
// Returns the reason why no vehicle departs within the run, or "" if one departs.
std::string sumo_demand_warning(const Scenario& scenario);

// Returns the hash of the contents of all files, or 0 for other network kinds.
std::uint64_t sumo_files_hash(const Scenario& scenario);

}  // namespace stopline
