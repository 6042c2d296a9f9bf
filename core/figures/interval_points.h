// Points of curves over time. Each point combines one or several successive measured intervals.
#pragma once

#include <cstddef>
#include <string>

#include "scenario/scenario.h"

namespace stopline {

// Returns the number of measured intervals that form one point: normally five, because single intervals would show the
// changes within each signal cycle. A run with fewer than ten intervals gets one interval per point.
std::size_t intervals_per_point(std::size_t intervals);

// Returns a description of the points, such as "means of 5 intervals of 60 s".
std::string points_text(std::size_t intervals, double interval_s);

// Returns the text that explains why a figure has no points: the run contains no whole measured interval.
std::string no_interval_text(const Scenario& scenario);

// Returns the gnuplot plotting style for this number of points. Few points are also marked, because a line alone is
// hard to see.
std::string curve_style(std::size_t points);

}  // namespace stopline
