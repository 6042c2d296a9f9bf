// What a user says of the network: the parameters of a generator. SI units.
#pragma once

#include <string>

namespace stopline {

// One straight approach with a stop line, and the road behind it.
struct ApproachSettings {
    int lanes = 1;
    double length_m = 700.0;       // entry to stop line
    double exit_length_m = 700.0;  // stop line to the end of the network
    double speed_limit_mps = 50.0 / 3.6;
    double gradient = 0.0;  // rise over run, positive uphill
};

struct NetworkSettings {
    std::string kind = "approach";
    ApproachSettings approach;
};

}  // namespace stopline
