// Calibration of the start-up (Section III.B): the leader's acceleration profile over speed is fitted so that the simulated
// start of the full-dynamics vehicle follows the mean of measured starts. Nothing else is fitted to anything here.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace stopline {

// Measured starts: mean speed over the time since the car moves. What the file does not have is empty.
struct StartupCurve {
    std::vector<double> time_s;  // rising from 0
    std::vector<double> mean_mps;
    std::vector<double> mean_ci_mps;  // half width of the 95 % interval of the mean
    std::vector<double> low_mps;      // 2.5 % and 97.5 % percentile of single starts; both or none
    std::vector<double> high_mps;
    std::vector<double> starts;  // behind each mean
};

// Reads columns t_s and mean_kmh and, where there are any, ci95_of_mean, p2.5, p97.5 and n. Throws InputError naming file and
// line.
StartupCurve load_startup_curve(const std::filesystem::path& file);

// The car counts as moving from this speed on, as in the measurements (OBD reports whole km/h, interpolated).
inline constexpr double kMoving_mps = 0.1;

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

// Where a start leaves a band, at the times of the run; between measured points the band is straight. One row an interval of
// time and side. None where the curve does not have that band.
struct BandExit {
    double from_s, to_s;
    double largest_mps;  // deviation from the mean, signed, where it is largest
};
std::vector<BandExit> band_exits(const StartupCurve& curve, const StartupRun& run, bool of_mean);

double rms_deviation_mps(const StartupCurve& curve, const StartupRun& run);

}  // namespace stopline
