// Sweeps the V2V delay and the time gap of a platoon, and finds the border of string stability: measured in full
// dynamics and computed with the linear analysis.
#pragma once

#include <string>
#include <vector>

#include "runs/strings/string_report.h"

namespace stopline {

struct StringSweepPoint {
    double v2v_delay_s = 0.0;
    double time_gap_s = 0.0;
    double measured_gain = 0.0;  // largest gain of all swings
    double measured_frequency_radps = 0.0;
    GainPeak linear;
    bool was_settled = true;
};

struct StringBorder {
    double v2v_delay_s = 0.0;
    // Smallest time gap without growing oscillations, interpolated between two swept time gaps. NaN: none of the swept
    // time gaps suffices. If all of them suffice, it is the smallest one.
    double measured_time_gap_s = 0.0;
    double linear_time_gap_s = 0.0;  // NaN: none up to 20 s
};

struct StringSweep {
    std::string population;
    std::vector<StringSweepPoint> points;  // by delay, then by time gap
    std::vector<StringBorder> border;      // one for each delay
    Violations violations;
    std::int64_t updates = 0;
};

struct StringSweepAxes {
    std::vector<double> v2v_delays_s;  // ascending
    std::vector<double> time_gaps_s;   // ascending
};

// Sweeps the first population, whose policy must have the parameter time_gap. Uses only the swings of the options.
// Throws as run_strings() does.
StringSweep sweep_strings(const Scenario& scenario, const StringOptions& options, const StringSweepAxes& axes);

// Returns the measured border from the points of one delay, in the order of their time gaps.
double measured_border_s(const std::vector<StringSweepPoint>& points);

}  // namespace stopline
