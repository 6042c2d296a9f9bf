// The main results of the reproduction in five lines. Three lines give the gain of CDG at one signal, at one
// intersection and in networks. One line gives the losses of CDG on the grid with turns. One line gives the number of
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

// Returns the five lines with our values from the scorecard. If a value was not measured, its line says so.
std::vector<Headline> headlines(const Scorecard& scorecard);

// Returns a sentence with the number of rows inside, outside and open. Inputs of the paper are not counted. Own
// rows are counted in a sentence of their own.
std::string results_text(const Scorecard& scorecard);

}  // namespace stopline
