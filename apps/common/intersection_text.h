// Tables of an intersection's runs for the terminal.
#pragma once

#include <string>

#include "experiment/intersection.h"

namespace stopline {

std::string intersection_text(const IntersectionReport& report);

}  // namespace stopline
