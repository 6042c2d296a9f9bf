// Result tables of a single intersection for the terminal.
#pragma once

#include <string>

#include "runs/intersection/intersection.h"

namespace stopline {

std::string intersection_text(const IntersectionReport& report);

}  // namespace stopline
