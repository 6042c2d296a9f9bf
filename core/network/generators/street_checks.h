// Checks that the user's settings of streets (street_settings.h) fit together. The field tables in scenario/schema
// check the range of each single setting.
#pragma once

#include <string>
#include <vector>

#include "network/street_settings.h"

namespace stopline {

struct StreetProblem {
    std::string field;  // path, such as intersections[suarezstr].legs[1].lanes[0].pocket
    std::string message;
};

// Returns the problems that prevent building a lane graph. The checks run in groups. If a group finds a problem, the
// later groups are skipped, because they rely on the success of the earlier ones.
std::vector<StreetProblem> street_problems(const StreetSettings& streets);

// Returns a message if the clearance is too large for the lane width, else "". Vehicles on two lanes can touch where
// the centre lines are closer than the clearance. In a turn, the centre lines of adjacent lanes are closer than the
// lane width. So the clearance must be at least 0.5 m below the lane width.
std::string clearance_problem(double clearance_m, double lane_width_m);

}  // namespace stopline
