// The legs that lead to the border of a network: their lengths, and the scenario fields that set these lengths. Error
// messages name the fields.
#pragma once

#include <string>
#include <vector>

#include "network/network_settings.h"

namespace stopline {

struct OuterLeg {
    std::string length_field;       // path of the scenario field that sets length_m
    std::string exit_length_field;  // path of the scenario field that sets exit_length_m
    double limit_mps = 0.0;         // speed limit
    double length_m = 0.0;          // from the border to the stop line; 0: no approach lane
    double exit_length_m = 0.0;     // from the intersection to the border; 0: no exit lane
};

// Returns the outer legs. A single road, an intersection and a grid have equal legs by definition, so the result holds
// only one of these legs. The result is empty for an imported network.
std::vector<OuterLeg> outer_legs(const NetworkSettings& network);

}  // namespace stopline
