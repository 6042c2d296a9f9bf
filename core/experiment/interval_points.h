// Points of figures over time: of how many measured intervals each is the mean.
#pragma once

#include <cstddef>
#include <string>

#include "scenario/scenario.h"

namespace stopline {

// Five, so that the greens of single cycles do not show; of runs with fewer than two such points each interval is one.
std::size_t intervals_of_a_point(std::size_t intervals);

// "means of 5 intervals of 60 s", for an axis.
std::string points_text(std::size_t intervals, double interval_s);

// Why there is no point.
std::string no_interval_text(const Scenario& scenario);

// How gnuplot draws so many points: a few would not be seen as a line.
std::string line_of(std::size_t points);

}  // namespace stopline
