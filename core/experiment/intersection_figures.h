// Figures of an intersection's runs: a still picture (Fig. 8 of the paper) and headways by position in the queue.
#pragma once

#include <vector>

#include "experiment/gnuplot.h"
#include "experiment/intersection.h"

namespace stopline {

// The network to scale with the vehicles of one population at `picture_s`, coloured by policy.
Figure intersection_picture(const IntersectionReport& report, std::size_t population);

// The picture, of the population with most policies, and the headways by position in the queue where there were enough.
std::vector<Figure> intersection_figures(const IntersectionReport& report);

}  // namespace stopline
