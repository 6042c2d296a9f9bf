// Figure of a simulated start: its speed and gear, compared with measured starts.
#pragma once

#include "calibration/startup_report.h"
#include "figures/gnuplot.h"

namespace stopline {

// Draws speed and gear over time, with the bands that the measured curve has.
Figure startup_figure(const StartupReport& report);

}  // namespace stopline
