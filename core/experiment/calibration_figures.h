// Figures of the calibration.
#pragma once

#include <vector>

#include "experiment/band_check.h"
#include "experiment/calibration.h"
#include "experiment/gnuplot.h"

namespace stopline {

// Detector counters of both modes over time (Fig. 11), for the permutation with the median and the one with the smallest share of
// pairs within the limit; a histogram of the differences; the fit's history, unless there is none.
std::vector<Figure> timing_figures(const std::vector<TimingResult>& results, const std::vector<CalibrationCase>& cases,
                                   const std::vector<FitEvaluation>& history);

// Bands of full dynamics with the means of the mesoscale mode, permutation by permutation (Fig. 12).
std::vector<Figure> band_figures(const BandCheck& check);

}  // namespace stopline
