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

}  // namespace stopline
