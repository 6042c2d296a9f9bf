// Sweep files, read through the same tables of fields and with the same messages as scenarios (load_scenario.h).
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

#include "scenario/sweep_settings.h"

namespace stopline {

// Every value is checked against the field it is for; what depends on several fields shows only in the combinations.
SweepSettings load_sweep(const std::filesystem::path& file);
// The same from text; `label` stands for the file in messages, `directory` is where relative paths in it start.
SweepSettings parse_sweep(std::string_view text, const std::string& label,
                          const std::filesystem::path& directory = ".");

// The overrides, as load_scenario takes them, that one value of an axis stands for; none for an axis of populations.
std::vector<std::string> axis_overrides(const SweepAxis& axis, std::size_t value);

// All fields as a table for people.
std::string describe_sweep_fields();

}  // namespace stopline
