// Exports a scenario as input of SUMO: the network, and the vehicles of one run in the mesoscale mode of Stopline.
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

// Returns the time at which a run of the scenario ends, s.
double run_end_s(const Scenario& scenario);

// Runs the simulation until `end_s` and calls all writers before each step and after the last step. Returns the summary
// text of each writer. `on_progress` gets the finished share of the run, 0 .. 1. If it returns false,
// run_with_writers() throws Interrupted.
std::vector<std::string> run_with_writers(Simulation& simulation, double end_s,
                                          const std::vector<std::unique_ptr<RunWriter>>& writers,
                                          const std::function<bool(double)>& on_progress);

// Throws InputError for networks of the kind 'sumo', because these networks already exist as SUMO files.
void check_exportable(const Scenario& scenario);

// Returns a sentence for the user if vehicles use the constant-distance model, which SUMO lacks. Returns "" otherwise.
std::string sumo_limits_note(const Model& model);

// Writes all files that inputs.h describes. If SUMO is installed, netconvert also builds the network file. The scenario
// must have `fidelity: meso`. Returns a text for the user with the number of vehicles and sumo_limits_note(). If the
// function throws, it leaves no files.
std::string export_to_sumo(const Scenario& scenario, std::size_t population, const std::filesystem::path& folder,
                           const std::function<bool(double)>& on_progress);

// Returns the index of the population with this name. Throws InputError, which lists the known names, if there is none.
std::size_t population_index(const Scenario& scenario, const std::string& name);

// Returns true if netconvert and sumo can be run.
bool has_sumo();
// Returns the shell command that builds the network file from the plain XML files in the folder.
std::string netconvert_command(const std::filesystem::path& folder);
// Runs netconvert to build the network file from the plain XML files in the folder. Throws InputError with the output
// of netconvert if it fails.
void make_net_file(const std::filesystem::path& folder);

}  // namespace stopline
