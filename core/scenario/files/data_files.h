// Reads the data files that a scenario names, such as vehicles, drivers and policies.
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

// Reads the data file that the scalar `reference` gives, either as a path or as the name of a file in `folder` of the
// data directory. `field` is the path of the scenario field, for messages. On failure, reports an error and returns a
// tree of the kind `broken`.
DataFile read_data_file(const std::string& folder, const SourceNode& reference, const std::string& field,
                        Report& report);

}  // namespace stopline
