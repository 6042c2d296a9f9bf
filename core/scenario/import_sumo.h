// SUMO's files of a scenario, read when it is loaded.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "scenario/scenario.h"

namespace stopline {

struct DemandPlan;

// A field of the scenario and what is wrong with it.
using FieldProblem = std::pair<std::string, std::string>;

// Files that are not there or cannot be read to an end. `directory`: where relative paths start.
std::vector<FieldProblem> sumo_file_problems(const Scenario& scenario, const std::filesystem::path& directory);

// Does nothing where the network is not of the kind `sumo`. Throws InputError with file and line.
void import_sumo(Scenario& scenario, const std::filesystem::path& directory);

// The trips of those files, with the policies that the plan's population gives them.
void add_sumo_trips(const Scenario& scenario, DemandPlan& plan);

// The induction loops of those files, on lanes of the graph.
struct SumoLoopPlace {
    std::string name;
    int lane = -1;
    double position_m = 0.0;
};
std::vector<SumoLoopPlace> sumo_loops(const Scenario& scenario);

// What those files have that is not read, a line each: "city.net.xml:12: ...".
std::vector<std::string> sumo_warnings(const Scenario& scenario);

// Routes that hold nobody at all.
std::vector<FieldProblem> sumo_demand_problems(const Scenario& scenario);
// Where nobody departs within the run: why. Empty: somebody does.
std::string sumo_demand_warning(const Scenario& scenario);

// Of their contents; 0: there are none.
std::uint64_t sumo_files_hash(const Scenario& scenario);

}  // namespace stopline
