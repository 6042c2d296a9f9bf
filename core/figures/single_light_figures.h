// Figures of a single signal: vehicle counters (Fig. 5), improvement over the baseline (Fig. 6), a time-space diagram,
// and speed and gap of some vehicles of the platoon.
#pragma once

#include <vector>

#include "figures/gnuplot.h"
#include "reference/targets.h"
#include "runs/single_light/single_light.h"

namespace stopline {

// Returns all figures that the results allow. `targets` holds numbers of the paper; the figures also show those numbers
// that belong to this scenario.
std::vector<Figure> single_light_figures(const SingleLightReport& result, const std::vector<Target>& targets);

Figure counters_figure(const SingleLightReport& result, const std::vector<Target>& targets);
Figure improvement_figure(const SingleLightReport& result, const std::vector<Target>& targets);
// The next two figures show two populations: the baseline and the first population that is not the baseline. If the
// scenario has no baseline, they show the first two populations.
Figure time_space_figure(const SingleLightReport& result);
Figure platoon_figure(const SingleLightReport& result);

// Returns the index of the line style of a population (population_style.h).
std::size_t style_index(const SingleLightReport& result, std::size_t population);

}  // namespace stopline
