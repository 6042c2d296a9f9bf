#include "calibration/startup_report.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "base/io/csv.h"
#include "base/units.h"

namespace stopline {

namespace {

constexpr double kFine_s = 0.05;

struct GearChange {
    double time_s;
    int from, to;
};

std::vector<GearChange> gear_changes(const StartupRun& run) {
    std::vector<GearChange> changes;
    for (std::size_t k = 1; k < run.gear.size(); ++k) {
        if (run.gear[k] != run.gear[k - 1]) changes.push_back({run.time_s[k], run.gear[k - 1], run.gear[k]});
    }
    return changes;
}

// Returns explanations of an exit, which is a time interval in which the simulated speed is outside a band. Causes are
// the definition of time 0, the interpolation between the first two measured points, and gear changes. A gear change
// shortly before an exit or during it makes the car slower than the band. A gear change during an exit or right after
// it ends a time in which the car is faster than the band.
std::string remark(const StartupReport& report, const BandExit& exit) {
    constexpr double kBefore_s = 1.0;
    constexpr double kBehind_s = 2.5 * kFine_s;
    std::string text;
    if (exit.from_s == 0.0) {
        text += fmt::format("; time 0 is where the simulated car reaches {:.1f} km/h", kMoving_mps * kKmhPerMps);
    } else if (exit.from_s < report.curve.time_s[1]) {
        text += fmt::format("; measured points are at 0 and {:g} s, the band between them is interpolated",
                            report.curve.time_s[1]);
    }
    const bool ahead = exit.largest_deviation_mps > 0.0;
    for (const GearChange& change : gear_changes(report.fine)) {
        const double from_s = ahead ? exit.from_s : exit.from_s - kBefore_s;
        const double to_s = ahead ? exit.to_s + kBehind_s : exit.to_s;
        if (change.time_s < from_s || change.time_s > to_s) continue;
        text += fmt::format("; {}gear change {}-{} at {:.2f} s interrupts the torque", ahead ? "ahead until " : "",
                            change.from, change.to, change.time_s);
    }
    return text;
}

std::string exits_text(const StartupReport& report, bool of_mean) {
    const std::vector<BandExit> exits = band_exits(report.curve, report.fine, of_mean);
    if (exits.empty()) return "  never\n";
    std::string text;
    for (const BandExit& exit : exits) {
        text += fmt::format("  {:5.2f} to {:5.2f} s, by {:+.1f} km/h from the mean{}\n", exit.from_s, exit.to_s,
                            exit.largest_deviation_mps * kKmhPerMps, remark(report, exit));
    }
    return text;
}

std::string bands_text(const StartupReport& report) {
    const StartupCurve& curve = report.curve;
    std::string text;
    if (!curve.mean_ci_mps.empty()) {
        const std::string starts = starts_text(curve);
        const double widest_mps = *std::max_element(curve.mean_ci_mps.begin(), curve.mean_ci_mps.end());
        text += fmt::format("\noutside the 95 % interval of the mean ({}half width at most {:.1f} km/h):\n{}",
                            starts.empty() ? "" : starts + "; ", widest_mps * kKmhPerMps, exits_text(report, true));
    }
    if (!curve.low_mps.empty()) {
        text += "\noutside the band of single starts (2.5 to 97.5 %):\n" + exits_text(report, false);
    }
    return text;
}

// Returns value k of a band in km/h, or NaN if the curve has no such band.
double band_kmh(const std::vector<double>& band_mps, std::size_t k) {
    return band_mps.empty() ? std::nan("") : band_mps[k] * kKmhPerMps;
}

double time_to_reach_s(const StartupRun& run, double speed_mps) {
    for (std::size_t k = 0; k < run.time_s.size(); ++k) {
        if (run.speed_mps[k] >= speed_mps) return run.time_s[k];
    }
    return std::nan("");
}

}  // namespace

StartupReport report_startup(const Scenario& scenario, const StartupCurve& curve) {
    std::vector<double> times_s;
    for (int k = 0; k * kFine_s <= curve.time_s.back(); ++k) times_s.push_back(k * kFine_s);
    return {curve, simulate_start(scenario, curve.time_s), simulate_start(scenario, times_s), scenario.vehicle_name,
            scenario.driver_name};
}

std::string startup_csv(const StartupReport& report) {
    CsvWriter csv({"time_s", "simulated_kmh", "measured_mean_kmh", "mean_ci95_kmh", "p2.5_kmh", "p97.5_kmh", "gear",
                   "distance_m"});
    const StartupCurve& curve = report.curve;
    for (std::size_t k = 0; k < curve.time_s.size(); ++k) {
        csv.row({fmt::format("{:.6g}", curve.time_s[k]), fixed(report.run.speed_mps[k] * kKmhPerMps, 2),
                 fixed(curve.mean_mps[k] * kKmhPerMps, 2), fixed(band_kmh(curve.mean_ci_mps, k), 2),
                 fixed(band_kmh(curve.low_mps, k), 2), fixed(band_kmh(curve.high_mps, k), 2),
                 fmt::format("{}", report.run.gear[k]), fixed(report.run.distance_m[k], 2)});
    }
    return csv.text();
}

std::string startup_text(const StartupReport& report) {
    const StartupCurve& curve = report.curve;
    const bool interval = !curve.mean_ci_mps.empty();
    std::string text = fmt::format("{:>7} {:>15} {:>14}{} {:>5} {:>12}\n", "time s", "simulated km/h", "measured km/h",
                                   interval ? fmt::format(" {:>12}", "95 % of mean") : "", "gear", "distance m");
    for (std::size_t k = 0; k < curve.time_s.size(); k += 2) {
        const std::string width = fmt::format("+-{:.1f}", band_kmh(curve.mean_ci_mps, k));
        text +=
            fmt::format("{:7.1f} {:15.1f} {:14.1f}{} {:5} {:12.1f}\n", curve.time_s[k],
                        report.run.speed_mps[k] * kKmhPerMps, curve.mean_mps[k] * kKmhPerMps,
                        interval ? fmt::format(" {:>12}", width) : "", report.run.gear[k], report.run.distance_m[k]);
    }
    text += fmt::format("\nroot mean square deviation from the mean: {:.2f} km/h\n",
                        rms_deviation_mps(curve, report.run) * kKmhPerMps);
    const double reached_s = time_to_reach_s(report.fine, 49.5 * kMpsPerKmh);
    if (!std::isnan(reached_s)) text += fmt::format("reaches 49.5 km/h {:.1f} s after it begins to move\n", reached_s);
    return text + bands_text(report);
}

std::string starts_text(const StartupCurve& curve) {
    if (curve.starts.empty()) return "";
    const auto [least, most] = std::minmax_element(curve.starts.begin(), curve.starts.end());
    return *least == *most ? fmt::format("{:g} starts", *least) : fmt::format("{:g} to {:g} starts", *least, *most);
}

}  // namespace stopline
