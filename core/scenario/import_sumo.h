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

// The path of a scenario field, and the text of the error in this field.
using FieldProblem = std::pair<std::string, std::string>;

// Returns one entry for each SUMO file of the scenario that does not exist or cannot be read. Relative paths start at
// `directory`.
std::vector<FieldProblem> sumo_file_problems(const Scenario& scenario, const std::filesystem::path& directory);

// Reads the SUMO network, additional and route files that the scenario names, and stores their content in the scenario.
// Throws InputError with file and line if a file is invalid.
void import_sumo(Scenario& scenario, const std::filesystem::path& directory);

// Adds the imported trips to the demand plan. Assigns a spacing policy to each trip, by the plan's policy shares and in
// the order that the plan's `pattern` gives (alternating, random or balanced).
void add_sumo_trips(const Scenario& scenario, DemandPlan& plan);

// An imported induction loop.
struct SumoLoopPlace {
    std::string name;
    int lane = -1;  // index into the lane graph
    double position_m = 0.0;
};
std::vector<SumoLoopPlace> sumo_loops(const Scenario& scenario);

// Returns the warnings of the import, one line each, such as "city.net.xml:12: ...". Most of them name a part of the
// files that the import ignores.
std::vector<std::string> sumo_warnings(const Scenario& scenario);

// Returns notes about choices of the import, one line each. An example is the default departure lane and speed for
// vehicles without these attributes.
std::vector<std::string> sumo_notes(const Scenario& scenario);

// Returns an error if the SUMO files have no vehicle, trip or flow.
std::vector<FieldProblem> sumo_demand_problems(const Scenario& scenario);
// Returns the reason why no vehicle departs within the run, or "" if a vehicle departs.
std::string sumo_demand_warning(const Scenario& scenario);

// Returns a hash of the contents of all SUMO files; 0 if the scenario has none.
std::uint64_t sumo_files_hash(const Scenario& scenario);

}  // namespace stopline
