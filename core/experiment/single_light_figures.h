// The figures of a single light: vehicle counters (Fig. 5), improvement over the baseline (Fig. 6), time-space diagram, and
// speed and gap of some vehicles of the platoon.
#pragma once

#include <vector>

#include "experiment/gnuplot.h"
#include "experiment/single_light.h"
#include "experiment/targets.h"

namespace stopline {

// All figures that the results allow. The paper's own numbers among `targets` appear where they are of this scenario.
std::vector<Figure> single_light_figures(const SingleLight& result, const std::vector<Target>& targets);

Figure counters_figure(const SingleLight& result, const std::vector<Target>& targets);
Figure improvement_figure(const SingleLight& result, const std::vector<Target>& targets);
// Of the first population above the baseline (or of the first two, or of the only one).
Figure time_space_figure(const SingleLight& result);
Figure platoon_figure(const SingleLight& result);

// Which of the line styles a population has in all figures: the baseline the black one, the others the rest in their order.
std::size_t style_index(const SingleLight& result, std::size_t population);

}  // namespace stopline
