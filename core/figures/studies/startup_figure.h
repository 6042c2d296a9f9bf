// Figure of a simulated start: speed, compared with measured starts, and gear.
#pragma once

#include "calibration/startup_report.h"
#include "figures/gnuplot.h"

namespace stopline {

// Draws speed and gear over time, with those bands of speed that the measured curve has.
Figure startup_figure(const StartupReport& report);

}  // namespace stopline
