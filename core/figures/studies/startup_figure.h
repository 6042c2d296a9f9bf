// Figure of a simulated start: speed, compared with measured starts, and gear.
#pragma once

#include "calibration/startup_report.h"
#include "figures/gnuplot.h"

namespace stopline {

// Draws speed and gear over time. If the measured curve contains them, also draws two bands: the range of 95 % of the
// measured starts, and the confidence band of their mean.
Figure startup_figure(const StartupReport& report);

}  // namespace stopline
