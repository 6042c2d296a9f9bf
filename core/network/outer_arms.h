// Where a network ends: the lengths of the arms that lead to its border, and the fields that say them.
#pragma once

#include <string>
#include <vector>

#include "network/network_settings.h"

namespace stopline {

struct OuterArm {
    std::string length_field;  // as in a scenario
    std::string exit_length_field;
    double limit_mps = 0.0;
    double length_m = 0.0;       // from the border to the stop line; 0: no lane leads in
    double exit_length_m = 0.0;  // from the intersection to the border; 0: none leads out
};

// One that stands for all where they are alike; none of an imported network.
std::vector<OuterArm> outer_arms(const NetworkSettings& network);

}  // namespace stopline
