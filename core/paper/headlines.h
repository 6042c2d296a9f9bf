// The main results of the reproduction in five lines: the gain of CDG by network, the cost of CDG, and the number of
// scorecard rows inside their tolerance.
#pragma once

#include <string>
#include <vector>

#include "paper/scorecard.h"

namespace stopline {

struct Headline {
    std::string topic;
    std::string text;
};

// Returns the five lines with our values from the scorecard. If values of a line were not measured, the line says
// which.
std::vector<Headline> headlines(const Scorecard& scorecard);

}  // namespace stopline
