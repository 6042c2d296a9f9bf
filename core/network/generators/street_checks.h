// Checks of streets that concern several fields together. The ranges of single fields are checked elsewhere.
#pragma once

#include <string>
#include <vector>

#include "network/street_settings.h"

namespace stopline {

struct StreetProblem {
    std::string field;  // path, such as intersections[suarezstr].legs[1].lanes[0].pocket
    std::string message;
};

// Returns all problems that prevent building a lane graph. A check is skipped if an earlier check found a problem that
// it depends on.
std::vector<StreetProblem> street_problems(const StreetSettings& streets);

// Returns a message if the clearance is too large for the lane width, else "". Vehicles touch where their centre lines
// are closer than the clearance. Within a turn the connections of neighbouring lanes are closer than the lane width, so
// the clearance must be 0.5 m below it.
std::string clearance_problem(double clearance_m, double lane_width_m);

}  // namespace stopline
