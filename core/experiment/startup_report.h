// What the start-up calibration shows: tables as text and CSV, the figure of speed and gear beside the measured starts.
#pragma once

#include <string>

#include "experiment/gnuplot.h"
#include "experiment/startup.h"

namespace stopline {

struct StartupReport {
    StartupCurve curve;
    StartupRun run;   // at the times of the curve
    StartupRun fine;  // the same start every 0.05 s, for the figure
    std::string vehicle;
    std::string driver;
};

// Simulates the scenario's start and puts it beside the curve.
StartupReport report_startup(const Scenario& scenario, const StartupCurve& curve);

// time, simulated and measured speed, both bands, gear, distance; marks the bands that are left.
std::string startup_csv(const StartupReport& report);

// Where the start leaves the bands and why, as sentences.
std::string startup_text(const StartupReport& report);

Figure startup_figure(const StartupReport& report);

}  // namespace stopline
