#include "experiment/startup_report.h"

#include <cmath>

#include <fmt/format.h>

#include "base/units.h"
#include "experiment/csv.h"

namespace stopline {

namespace {

std::string reason(const BandExit& exit) {
    if (exit.gear_after > exit.gear_before) {
        return fmt::format("gear change {}-{}: no torque while it lasts, a mean of 117 starts smears it out",
                           exit.gear_before, exit.gear_after);
    }
    if (exit.to_s < 1.0) return "torque and brake lag: the measured curve is interpolated from samples 0.9 s apart";
    return exit.largest_mps > 0.0 ? "runs ahead before the next gear change" : "recovers from the gear change before";
}

std::string exits_text(const StartupReport& report, bool of_mean) {
    const std::vector<BandExit> exits = band_exits(report.curve, report.run, of_mean);
    if (exits.empty()) return "  never\n";
    std::string text;
    for (const BandExit& exit : exits) {
        text += fmt::format("  {:4.1f} to {:4.1f} s, by {:+.1f} km/h from the mean: {}\n", exit.from_s, exit.to_s,
                            exit.largest_mps * kKmhPerMps, reason(exit));
    }
    return text;
}

double time_to_reach_s(const StartupRun& run, double speed_mps) {
    for (std::size_t k = 0; k < run.time_s.size(); ++k) {
        if (run.speed_mps[k] >= speed_mps) return run.time_s[k];
    }
    return std::nan("");
}

}  // namespace

StartupReport report_startup(const Scenario& scenario, const StartupCurve& curve) {
    constexpr double kFine_s = 0.05;
    std::vector<double> times_s;
    for (int k = 0; k * kFine_s <= curve.time_s.back(); ++k) times_s.push_back(k * kFine_s);
    return {curve, simulate_start(scenario, curve.time_s), simulate_start(scenario, times_s), scenario.vehicle_name,
            scenario.driver_name};
}

std::string startup_csv(const StartupReport& report) {
    CsvWriter csv({"time_s", "simulated_kmh", "measured_mean_kmh", "mean_ci95_kmh", "low_2.5_kmh", "high_97.5_kmh",
                   "gear", "distance_m"});
    const StartupCurve& curve = report.curve;
    for (std::size_t k = 0; k < curve.time_s.size(); ++k) {
        csv.row({fixed(curve.time_s[k], 1), fixed(report.run.speed_mps[k] * kKmhPerMps, 2),
                 fixed(curve.mean_mps[k] * kKmhPerMps, 2), fixed(curve.mean_ci_mps[k] * kKmhPerMps, 2),
                 fixed(curve.low_mps[k] * kKmhPerMps, 2), fixed(curve.high_mps[k] * kKmhPerMps, 2),
                 fmt::format("{}", report.run.gear[k]), fixed(report.run.distance_m[k], 2)});
    }
    return csv.text();
}

std::string startup_text(const StartupReport& report) {
    std::string text = fmt::format("{:>7} {:>15} {:>14} {:>12} {:>5} {:>12}\n", "time s", "simulated km/h",
                                   "measured km/h", "95 % of mean", "gear", "distance m");
    for (std::size_t k = 0; k < report.curve.time_s.size(); k += 2) {
        text += fmt::format("{:7.1f} {:15.1f} {:14.1f} {:>12} {:5} {:12.1f}\n", report.curve.time_s[k],
                            report.run.speed_mps[k] * kKmhPerMps, report.curve.mean_mps[k] * kKmhPerMps,
                            fmt::format("+-{:.1f}", report.curve.mean_ci_mps[k] * kKmhPerMps), report.run.gear[k],
                            report.run.distance_m[k]);
    }
    text += fmt::format("\nroot mean square deviation from the mean: {:.2f} km/h\n",
                        rms_deviation_mps(report.curve, report.run) * kKmhPerMps);
    text += fmt::format("reaches 49.5 km/h {:.1f} s after it moves\n", time_to_reach_s(report.run, 49.5 * kMpsPerKmh));
    text += "\nleaves the 95 % interval of the mean (117 starts; half width at most 1.5 km/h):\n" +
            exits_text(report, true);
    text += "\nleaves the band of single starts (2.5 to 97.5 %):\n" + exits_text(report, false);
    return text;
}

Figure startup_figure(const StartupReport& report) {
    Figure figure;
    figure.name = "startup";
    figure.height_px = 640;
    CsvWriter fine({"time_s", "simulated_kmh", "gear"});
    for (std::size_t k = 0; k < report.fine.time_s.size(); ++k) {
        fine.row({fixed(report.fine.time_s[k], 2), fixed(report.fine.speed_mps[k] * kKmhPerMps, 3),
                  fmt::format("{}", report.fine.gear[k])});
    }
    figure.data = {{"startup.csv", startup_csv(report)}, {"startup_fine.csv", fine.text()}};
    figure.body = fmt::format(
        "set datafile separator ','\n"
        "set multiplot\n"
        "set lmargin 10\nset rmargin 3\n"
        "set tmargin at screen 0.93\nset bmargin at screen 0.36\n"
        "set title {}\n"
        "unset xlabel\nset ylabel 'speed [km/h]'\nset xrange [0:20]\nset yrange [0:60]\nset ytics 10\nset format x ''\n"
        "set key bottom right\n"
        "plot 'startup.csv' skip 1 using 1:5:6 with filledcurves fc rgb '#e8e8e8' title 'single starts, 2.5 to 97.5 %', \\\n"
        "     '' skip 1 using 1:($3-$4):($3+$4) with filledcurves fc rgb '#a8c8e8' title '95 % interval of the mean', \\\n"
        "     '' skip 1 using 1:3 with lines lc rgb '#0072b2' dt 1 lw 3 title 'measured mean of 117 starts', \\\n"
        "     'startup_fine.csv' skip 1 using 1:2 with lines lc rgb '#d55e00' dt 1 lw 2 title 'simulated'\n"
        "unset title\nset tmargin at screen 0.32\nset bmargin at screen 0.11\n"
        "set ylabel 'gear'\nset yrange [0:6]\nset ytics 1\nset format x '%g'\n"
        "set xlabel 'time after the car moves [s]'\nunset key\n"
        "plot 'startup_fine.csv' skip 1 using 1:3 with steps lc rgb '#d55e00' dt 1 lw 2\n"
        "unset multiplot\n",
        gnuplot_text(
            fmt::format("Start-up: {} with driver {}, beside measured starts", report.vehicle, report.driver)));
    return figure;
}

}  // namespace stopline
