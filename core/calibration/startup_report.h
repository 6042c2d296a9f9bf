// Tables of the start-up calibration as text and CSV.
#pragma once

#include <string>

#include "calibration/startup.h"

namespace stopline {

struct StartupReport {
    StartupCurve curve;
    StartupRun run;   // sampled at the times of the curve
    StartupRun fine;  // the same start every 0.05 s, for the figure and the exits from the bands
    std::string vehicle;
    std::string driver;
};

// Simulates the start of the scenario's vehicle and compares it with the curve.
StartupReport report_startup(const Scenario& scenario, const StartupCurve& curve);

// Returns time, simulated and measured speed, both bands, gear and distance as CSV. A band that the curve lacks is
// empty.
std::string startup_csv(const StartupReport& report);

// Returns a table of speeds and the exits from the bands as text.
std::string startup_text(const StartupReport& report);

// Returns how many measured starts the curve has, as text; empty if unknown.
std::string starts_text(const StartupCurve& curve);

}  // namespace stopline
