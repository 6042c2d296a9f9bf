// Exports a scenario as input of SUMO: its network, and the vehicles of one run in the mesoscale mode.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "record/run_writer.h"
#include "scenario/scenario.h"
#include "sim/step/simulation.h"

namespace stopline {

// Returns the time at which the run of the scenario ends.
double run_end_s(const Scenario& scenario);

// Runs the simulation until `end_s` and calls the writers before each step and after the last. `on_progress` gets the
// share done and returns false to stop; then the function throws Interrupted. Returns the summary text of each writer.
std::vector<std::string> run_with_writers(Simulation& simulation, double end_s,
                                          const std::vector<std::unique_ptr<RunWriter>>& writers,
                                          const std::function<bool(double)>& on_progress);

// Throws InputError for networks of the kind 'sumo', because they exist as SUMO files already.
void check_exportable(const Scenario& scenario);

// Returns a sentence about features of the model that SUMO lacks, or "" if there are none.
std::string sumo_limits_note(const Model& model);

// Writes all files of inputs.h, and the network that netconvert builds from them if has_sumo(). Needs `fidelity:
// meso`. Returns a text with the number of vehicles and sumo_limits_note(). Leaves no files if it throws.
std::string export_to_sumo(const Scenario& scenario, std::size_t population, const std::filesystem::path& folder,
                           const std::function<bool(double)>& on_progress);

// Returns the index of the population with this name. Throws InputError with the known names.
std::size_t population_index(const Scenario& scenario, const std::string& name);

// Returns true if netconvert and sumo can be run.
bool has_sumo();
// Returns the shell command that builds the network in the folder.
std::string netconvert_command(const std::filesystem::path& folder);
// Builds the network in the folder with netconvert. Throws InputError with the output of netconvert.
void make_net_file(const std::filesystem::path& folder);

}  // namespace stopline
