// A scenario as input of SUMO: its network, and the vehicles of a run of it in the mesoscale mode.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "record/run_writer.h"
#include "scenario/scenario.h"
#include "sim/simulation.h"

namespace stopline {

// When the scenario's run ends.
double run_end_s(const Scenario& scenario);

// Steps to the end; the writers look on, and finish. `on_progress` gets the share done and returns false to stop: then Interrupted is
// thrown. What the writers say, one each.
std::vector<std::string> run_watched(Simulation& simulation, double end_s,
                                     const std::vector<std::unique_ptr<RunWriter>>& writers,
                                     const std::function<bool(double)>& on_progress);

// Throws InputError for networks of the kind 'sumo': they are SUMO's files already.
void check_exportable(const Scenario& scenario);

// What SUMO cannot do that this population does, as a sentence; empty: nothing.
std::string stand_in_note(const Model& model);

// Writes all files (sumo/inputs.h), the network itself if has_sumo(), or none where it throws. Needs `fidelity: meso`. Says how many
// vehicles, and what SUMO cannot do.
std::string export_to_sumo(const Scenario& scenario, std::size_t population, const std::filesystem::path& folder,
                           const std::function<bool(double)>& on_progress);

// By its name; throws InputError that lists those there are.
std::size_t population_index(const Scenario& scenario, const std::string& name);

bool has_sumo();  // netconvert and sumo are in PATH
std::string netconvert_command(const std::filesystem::path& folder);
// Runs it. Throws InputError with what netconvert said.
void make_net_file(const std::filesystem::path& folder);

}  // namespace stopline
