// Calibration of the start-up (Section III.B): the leader's acceleration profile over speed is fitted so that the simulated
// start of the full-dynamics vehicle follows the mean of measured starts. Nothing else is fitted to anything here.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace stopline {

// A measured start: speed over the time since the car moves, with two bands.
struct StartupCurve {
    std::vector<double> time_s;
    std::vector<double> mean_mps;
    std::vector<double> mean_ci_mps;  // half width of the 95 % interval of the mean
    std::vector<double> low_mps;      // 2.5 % and 97.5 % percentile of single starts
    std::vector<double> high_mps;
};

// Reads columns t_s, mean_kmh, sd_kmh, ci95_of_mean, p2.5, p97.5. Throws InputError naming file and line.
StartupCurve load_startup_curve(const std::filesystem::path& file);

// A simulated start of one vehicle at a light, sampled at the given times after it moves.
struct StartupRun {
    std::vector<double> time_s;
    std::vector<double> speed_mps;
    std::vector<double> distance_m;  // from standstill
    std::vector<int> gear;           // from 1
};
StartupRun simulate_start(const Scenario& scenario, const std::vector<double>& times_s);

struct StartupFit {
    DriverSettings driver;        // the scenario's, with the fitted profile
    double rms_before_mps = 0.0;  // root mean square deviation from the mean curve
    double rms_after_mps = 0.0;
    int evaluations = 0;
};
// Fits with NLopt's BOBYQA (Powell 2009). `on_progress` gets the evaluations done; false to stop: throws Interrupted.
StartupFit fit_startup(const Scenario& scenario, const StartupCurve& curve,
                       const std::function<bool(int)>& on_progress = {});

// Where a start leaves a band: one row an interval of time.
struct BandExit {
    double from_s, to_s;
    double largest_mps;           // deviation from the mean, signed, where it is largest
    int gear_before, gear_after;  // a gear change within the interval or up to 1 s before it explains a dent
};
std::vector<BandExit> band_exits(const StartupCurve& curve, const StartupRun& run, bool of_mean);

double rms_deviation_mps(const StartupCurve& curve, const StartupRun& run);

}  // namespace stopline
