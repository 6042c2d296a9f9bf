// Finds data files that a scenario names: vehicles, drivers, policies and others. load_scenario.h describes the names.
#pragma once

#include <filesystem>
#include <string>

#include "scenario/schema/report.h"
#include "scenario/yaml/source_node.h"

namespace stopline {

struct DataFile {
    SourceNode tree;
    std::string stem;  // file name without extension
};

// Reads the file that the scalar `reference` names: a file in a folder of the data directory, or a path. `field` is the
// path of the field in messages. On failure it reports an error and returns a broken tree.
DataFile read_data_file(const std::string& folder, const SourceNode& reference, const std::string& field,
                        Report& report);

}  // namespace stopline
