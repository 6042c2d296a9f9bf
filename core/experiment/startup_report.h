// What the start-up calibration shows: tables as text and CSV, the figure of speed and gear beside the measured starts.
#pragma once

#include <string>

#include "experiment/gnuplot.h"
#include "experiment/startup.h"

namespace stopline {

struct StartupReport {
    StartupCurve curve;
    StartupRun run;   // at the times of the curve
    StartupRun fine;  // the same start every 0.05 s, for the figure and where it leaves the bands
    std::string vehicle;
    std::string driver;
};

// Simulates the scenario's start and puts it beside the curve.
StartupReport report_startup(const Scenario& scenario, const StartupCurve& curve);

// time, simulated and measured speed, both bands (empty where the curve has none), gear, distance
std::string startup_csv(const StartupReport& report);

// Table, and where the start leaves the bands that the curve has.
std::string startup_text(const StartupReport& report);

Figure startup_figure(const StartupReport& report);

}  // namespace stopline
