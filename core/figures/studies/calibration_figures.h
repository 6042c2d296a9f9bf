// Figures of the calibration of the mesoscale mode.
#pragma once

#include <vector>

#include "calibration/band_check.h"
#include "calibration/calibration.h"
#include "figures/gnuplot.h"

namespace stopline {

// Returns the figures of step I of the calibration. Two figures show the cumulative vehicle counts at the detectors
// over time, in full dynamics and in the mesoscale mode (Fig. 11). The first shows the permutation (combination of axis
// values) with the median share of passages within the time limit. The second shows the permutation with the lowest
// share. The third figure is a histogram of the differences between passage times. If `history` is not empty, the
// fourth figure is the history of the fit.
std::vector<Figure> timing_figures(const std::vector<TimingResult>& results, const std::vector<CalibrationCase>& cases,
                                   const std::vector<FitEvaluation>& history);

// Returns the figures of step II of the calibration, one for each metric: confidence bands of full dynamics and means
// of the mesoscale mode for all permutations (Fig. 12).
std::vector<Figure> band_figures(const BandCheck& check);

}  // namespace stopline
