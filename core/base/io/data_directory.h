// The folders of the shipped data and scenarios.
#pragma once

#include <filesystem>

namespace stopline {

// Returns the folder of the shipped data: the environment variable STOPLINE_DATA if it is set, else the data folder of
// the installation, else the data folder of the source tree.
std::filesystem::path data_directory();

// Throws InputError if data_directory() does not exist, for instance because the source tree was moved after the build.
void require_data_directory();

// Returns the folder of the shipped scenarios, which lies beside the data folder. Throws InputError if one of the two
// folders does not exist.
std::filesystem::path scenario_directory();

}  // namespace stopline
