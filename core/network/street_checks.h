// What must hold for streets as a whole, beyond the ranges of their single fields.
#pragma once

#include <string>
#include <vector>

#include "network/street_settings.h"

namespace stopline {

struct StreetProblem {
    std::string field;  // intersections[suarezstr].arms[1].lanes[0].pocket
    std::string message;
};

// Empty where a lane graph can be built. Fields that depend on others are looked at only where those are sound.
std::vector<StreetProblem> street_problems(const StreetSettings& streets);

// Vehicles touch whose centre lines are nearer than the clearance; ways of neighbouring lanes through a turn come a little nearer to
// each other than the lanes are wide. Empty where the clearance keeps enough below the width.
std::string clearance_problem(double clearance_m, double lane_width_m);

}  // namespace stopline
