// Calibration of the start-up (Section III.B of the paper). The fit chooses the acceleration of platoon leaders as a
// function of speed, so that the simulated start in full dynamics follows the mean of the measured starts.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/speed_thresholds.h"
#include "scenario/scenario.h"

namespace stopline {

// Measured starts: speed over the time since the car began to move. If the file lacks a quantity, its list is empty.
struct StartupCurve {
    std::vector<double> time_s;  // rising from 0
    std::vector<double> mean_mps;
    std::vector<double> mean_ci_mps;  // half width of the 95 % confidence interval of the mean
    // 2.5th percentile of single starts; low_mps and high_mps are both present or both empty.
    std::vector<double> low_mps;
    std::vector<double> high_mps;  // 97.5th percentile of single starts
    std::vector<double> starts;    // [time] number of starts in the mean
};

// Loads measured starts from a CSV file with the columns t_s and mean_kmh. The columns ci95_of_mean, p2.5 with p97.5,
// and n are optional. If the file is invalid, throws InputError with file and line.
StartupCurve load_startup_curve(const std::filesystem::path& file);

// Speed from which a car counts as moving, also in the measured curves. The measured cars reported their speed in whole
// km/h (OBD), so the time at which they reached this speed was interpolated.
inline constexpr double kMoving_mps = kStoppedSpeed_mps;

// A simulated start of one vehicle at a signal, sampled at given times after it begins to move.
struct StartupRun {
    std::vector<double> time_s;
    std::vector<double> speed_mps;
    std::vector<double> distance_m;  // distance driven since standstill
    std::vector<int> gear;           // from 1
};
StartupRun simulate_start(const Scenario& scenario, const std::vector<double>& times_s);

struct StartupFit {
    // The driver of the scenario with two fitted parts: the acceleration curve, and human.idm.acceleration
    // (fit_idm_acceleration_mps2() with the speed limit as desired speed).
    DriverSettings driver;
    double rms_before_mps = 0.0;  // root mean square deviation from the measured mean
    double rms_after_mps = 0.0;
    int evaluations = 0;
};
// Returns the root mean square deviation, m/s, of the intelligent driver model without a leader (driver/idm.h) from the
// mean of the measured starts. `desired_mps` is its desired speed.
double idm_deviation_mps(const StartupCurve& curve, double acceleration_mps2, double desired_mps);

// Returns the maximum acceleration of the intelligent driver model, m/s2, with the smallest idm_deviation_mps().
double fit_idm_acceleration_mps2(const StartupCurve& curve, double desired_mps);

// Fits the driver with NLopt's BOBYQA (Powell 2009). `on_progress` gets the number of evaluations; if it returns false,
// the fit throws Interrupted.
StartupFit fit_startup(const Scenario& scenario, const StartupCurve& curve,
                       const std::function<bool(int)>& on_progress = {});

// A time interval in which the speed of a start is above or below a band. Between measured points the band is
// interpolated.
struct BandExit {
    double from_s, to_s;
    double largest_deviation_mps;  // from the measured mean; negative if the simulated start is slower than the mean
};
// Returns the exits from the confidence band of the mean (`of_mean` true) or from the band of single starts (false).
// Returns nothing if the curve does not have that band.
std::vector<BandExit> band_exits(const StartupCurve& curve, const StartupRun& run, bool of_mean);

double rms_deviation_mps(const StartupCurve& curve, const StartupRun& run);

}  // namespace stopline
