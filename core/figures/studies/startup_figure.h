// Figure of a simulated start: speed, compared with measured starts, and gear.
#pragma once

#include "calibration/startup_report.h"
#include "figures/gnuplot.h"

namespace stopline {

// Draws speed and gear over time. Also draws the band of single starts and the confidence band of the mean, if the
// measured curve has them.
Figure startup_figure(const StartupReport& report);

}  // namespace stopline
