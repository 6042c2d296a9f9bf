// A sweep as loaded from YAML: which fields of a scenario take which values, in all combinations. Plain data.
#pragma once

#include <string>
#include <vector>

namespace stopline {

// Either fields and their values, or populations of the scenario.
struct SweepAxis {
    std::string name;
    std::vector<std::string> paths;        // fields that are set together
    std::vector<std::string> values;       // as --set takes them; "a | b" gives each of the paths its own
    std::vector<std::string> populations;  // "all": every one of the scenario
    std::string place;                     // of its name: file:line:column
};

struct SweepSettings {
    std::string name;
    std::string title;
    std::string scenario;  // file; relative to the current directory once loaded
    std::vector<SweepAxis> axes;
    int repetitions = 1;  // runs of each combination, with the scenario's seed + 0, 1, ...
};

inline constexpr const char* kAllPopulations = "all";

}  // namespace stopline
