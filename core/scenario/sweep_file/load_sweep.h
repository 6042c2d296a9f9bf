// Loads sweep files. Field tables and messages are like those of scenario files (load_scenario.h). Example:
//
//     scenario: ../intersection.yaml
//     axes:
//     - {name: green, path: signal.green, values: [5 s, 10 s]}
//     - {name: population, populations: [CTG-Ref, CDG]}
//     repetitions: 6
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/sweep_file/sweep_settings.h"

namespace stopline {

// Loads a sweep file. Checks each value of an axis by the rules (unit, range) that the field tables (scenario/schema)
// state for the field that the axis sets. Throws InputError for a file that cannot be used. Checks that compare several
// fields are made later, when Sweep loads the combinations (sweeps/sweep.h).
SweepSettings load_sweep(const std::filesystem::path& file);
// Loads a sweep from text. `label` stands for the file in messages. Relative paths in the text start at `directory`.
SweepSettings parse_sweep(std::string_view text, const std::string& label,
                          const std::filesystem::path& directory = ".");

// Returns the overrides for load_scenario() that set the fields of an axis to axis.values[value]. Returns none for an
// axis of populations.
std::vector<std::string> axis_overrides(const SweepAxis& axis, std::size_t value);

// Returns a list of all fields of a sweep file for a terminal.
std::string describe_sweep_fields();

}  // namespace stopline
