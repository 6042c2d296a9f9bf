// A sweep as loaded from YAML: values for some fields of a scenario, run in all combinations. Plain data.
#pragma once

#include <string>
#include <vector>

namespace stopline {

// One axis of a sweep: fields with their values, or populations of the scenario.
struct SweepAxis {
    std::string name;
    std::vector<std::string> paths;        // fields that change together
    std::vector<std::string> values;       // written as for --set; "a | b" gives each path its own value
    std::vector<std::string> populations;  // names, or "all" for all populations of the scenario
    std::string place;                     // "file:line:column" of the name
};

struct SweepSettings {
    std::string name;
    std::string title;
    std::string scenario;  // file, relative to the current directory
    std::vector<SweepAxis> axes;
    int repetitions = 1;                     // runs per combination, with the seed of the scenario + 0, 1, ...
    std::vector<std::string> warnings = {};  // of loading, one line each, such as old names of fields
};

inline constexpr const char* kAllPopulations = "all";

}  // namespace stopline
