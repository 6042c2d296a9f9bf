// Finds the files that a scenario refers to by name: vehicles, drivers, policies. See load_scenario.h for the rules.
#pragma once

#include <filesystem>
#include <string>

#include "scenario/report.h"
#include "scenario/source_node.h"

namespace stopline {

// Reads the file that `reference` (a scalar) names in a folder of the data directory, or the file at that path. On failure
// the error is reported and the result is broken. `stem` is the file's name without extension.
struct DataFile {
    SourceNode tree;
    std::string stem;
};
DataFile read_data_file(const std::string& folder, const SourceNode& reference, const std::string& field,
                        Report& report);

}  // namespace stopline
