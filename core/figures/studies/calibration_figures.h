// Figures of the calibration of the mesoscale mode.
#pragma once

#include <vector>

#include "calibration/band_check.h"
#include "calibration/calibration.h"
#include "figures/gnuplot.h"

namespace stopline {

// Returns the figures of step I of the calibration: detector counters of both fidelities over time (Fig. 11) for the
// median and the worst permutation, a histogram of the differences between passage times, and the history of the fit if
// there is one. A permutation is a combination of axis values.
std::vector<Figure> timing_figures(const std::vector<TimingResult>& results, const std::vector<CalibrationCase>& cases,
                                   const std::vector<FitEvaluation>& history);

// Returns the figures of step II of the calibration, one for each metric: confidence bands of full dynamics and means
// of the mesoscale mode for all permutations (Fig. 12).
std::vector<Figure> band_figures(const BandCheck& check);

}  // namespace stopline
