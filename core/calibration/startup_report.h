// Tables of the start-up calibration as text and CSV.
#pragma once

#include <string>

#include "calibration/startup.h"

namespace stopline {

struct StartupReport {
    StartupCurve curve;
    StartupRun run;   // sampled at the times of the curve
    StartupRun fine;  // the same start, sampled every 0.05 s for the figure and the exits from the bands
    std::string vehicle;
    std::string driver;
};

// Simulates the start of the scenario's vehicle and compares it with the curve.
StartupReport report_startup(const Scenario& scenario, const StartupCurve& curve);

// Returns time, simulated and measured speed, both bands, gear and distance as CSV. The columns of a band that the
// curve lacks are empty.
std::string startup_csv(const StartupReport& report);

// Returns the results as text: a table of simulated and measured speeds, and the time intervals in which the simulated
// speed is outside a measured band.
std::string startup_text(const StartupReport& report);

// Returns the number of measured starts as text, such as "20 to 22 starts"; empty if the curve does not contain these
// numbers.
std::string starts_text(const StartupCurve& curve);

}  // namespace stopline
