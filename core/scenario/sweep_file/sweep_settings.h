// A sweep as loaded from YAML. Each axis lists values of scenario fields, and all combinations of axis values are run.
// Plain data.
#pragma once

#include <string>
#include <vector>

namespace stopline {

// One axis of a sweep. It lists either values of one or more fields, or populations of the scenario.
struct SweepAxis {
    std::string name;
    std::vector<std::string> paths;              // paths of the scenario fields that change together
    std::vector<std::string> values;             // as in an override PATH=VALUE; "a | b": one value for each of 2 paths
    std::vector<std::string> populations;        // names of populations, or "all" for all populations of the scenario
    std::string place;                           // position of the axis name, "file:line:column"
    std::vector<std::string> value_places = {};  // [value] positions of the values
    std::vector<std::string> population_places = {};  // [population] positions of the names of populations
};

struct SweepSettings {
    std::string name;
    std::string file;  // name of the sweep file in messages
    std::string title;
    std::string scenario;  // path of the scenario file, relative to the current directory
    std::vector<SweepAxis> axes;
    int repetitions = 1;                     // runs per combination; run k (from 0) has the scenario's seed + k
    std::vector<std::string> warnings = {};  // warnings from loading, one line each, such as old names of fields
};

inline constexpr const char* kAllPopulations = "all";

}  // namespace stopline
