// Figures of the calibration of the mesoscale mode.
#pragma once

#include <vector>

#include "calibration/band_check.h"
#include "calibration/calibration.h"
#include "figures/gnuplot.h"

namespace stopline {

// Returns the figures of step I: detector counters of both fidelities over time (Fig. 11) for the median and the worst
// permutation, a histogram of the differences, and the history of the fit if there is one.
std::vector<Figure> timing_figures(const std::vector<TimingResult>& results, const std::vector<CalibrationCase>& cases,
                                   const std::vector<FitEvaluation>& history);

// Returns the figures of step II: bands of full dynamics and means of the mesoscale mode for each permutation (Fig.
// 12).
std::vector<Figure> band_figures(const BandCheck& check);

}  // namespace stopline
