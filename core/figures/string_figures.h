// Figures of stopline-strings: gain over frequency, accelerations by position, gaps during a manoeuvre, and the border
// of string stability.
#pragma once

#include <vector>

#include "figures/gnuplot.h"
#include "runs/strings/string_report.h"
#include "runs/strings/string_sweep.h"

namespace stopline {

// Returns all figures that the report allows.
std::vector<Figure> string_figures(const StringReport& report);

// Measured gain |Gamma| over frequency, beside that of the linear model.
Figure string_gain_figure(const StringReport& report);
// Largest acceleration by position, relative to that of the platoon leader, and largest gap error by position.
Figure string_positions_figure(const StringReport& report);
// Speed and net gap of some vehicles over time.
Figure string_motion_figure(const StringResult& result, const ManoeuvreResult& manoeuvre, std::size_t population);
// Largest gain over V2V delay and time gap, with both borders of string stability.
Figure string_border_figure(const StringSweep& sweep);

}  // namespace stopline
