// The answer of the reproduction in five lines: the gain of CDG by network, its cost, and the number of rows met.
#pragma once

#include <string>
#include <vector>

#include "paper/scorecard.h"

namespace stopline {

struct Headline {
    std::string topic;
    std::string text;
};

// Writes the lines from our values of the rows. A line says which of its values were not measured.
std::vector<Headline> headlines(const Scorecard& scorecard);

}  // namespace stopline
