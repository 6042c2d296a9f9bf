// A leg that leads to the border of a network: its lengths, and the scenario fields that set these lengths. Error
// messages name the fields.
#pragma once

#include <string>

namespace stopline {

struct OuterLeg {
    std::string length_field;       // path of the scenario field that sets length_m
    std::string exit_length_field;  // path of the scenario field that sets exit_length_m
    double limit_mps = 0.0;         // speed limit
    double length_m = 0.0;          // from the border to the stop line; 0: no approach lane
    double exit_length_m = 0.0;     // from the intersection to the border; 0: no exit lane
};

}  // namespace stopline
