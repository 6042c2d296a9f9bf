// Lists the files that a scenario reads, so that programs can refuse to overwrite them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stopline {

// Returns the scenario file and all files that it names: vehicles, drivers and other data files, SUMO files, counts and
// matrices. Checks nothing; load_scenario() reports errors. Throws InputError if the scenario file cannot be read.
std::vector<std::filesystem::path> scenario_files(const std::filesystem::path& file,
                                                  const std::vector<std::string>& overrides);

}  // namespace stopline
