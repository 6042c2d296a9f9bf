#include "figures/studies/startup_figure.h"

#include <fmt/format.h>

#include "base/io/csv.h"
#include "base/units.h"

namespace stopline {

namespace {

std::string plot_bands(const StartupCurve& curve) {
    std::string text;
    if (!curve.low_mps.empty()) {
        text +=
            "'startup.csv' skip 1 using 1:5:6 with filledcurves fc rgb '#e8e8e8' dt 1 title 'single starts, 2.5 to 97.5 %', ";
    }
    if (!curve.mean_ci_mps.empty()) {
        text +=
            "'startup.csv' skip 1 using 1:($3-$4):($3+$4) with filledcurves fc rgb '#a8c8e8' dt 1 "
            "title '95 % interval of the mean', ";
    }
    return text;
}

}  // namespace

Figure startup_figure(const StartupReport& report) {
    Figure figure;
    figure.name = "startup";
    figure.height_px = 640;
    const std::string starts = starts_text(report.curve);
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
        "unset xlabel\nset ylabel 'speed [km/h]'\nset xrange [0:{:g}]\nset yrange [0:*]\nset ytics 10\nset format x ''\n"
        "set key bottom right\n"
        "plot {}'startup.csv' skip 1 using 1:3 with lines lc rgb '#0072b2' dt 1 lw 3 title {}, \\\n"
        "     'startup_fine.csv' skip 1 using 1:2 with lines lc rgb '#d55e00' dt 1 lw 2 title 'simulated'\n"
        "unset title\nset tmargin at screen 0.32\nset bmargin at screen 0.11\n"
        "set ylabel 'gear'\nset yrange [0:6]\nset ytics 1\nset format x '%g'\n"
        "set xlabel 'time since the car began to move [s]'\nunset key\n"
        "plot 'startup_fine.csv' skip 1 using 1:3 with steps lc rgb '#d55e00' dt 1 lw 2\n"
        "unset multiplot\n",
        gnuplot_text(fmt::format("Start of {} with driver {}, and measured starts", report.vehicle, report.driver)),
        report.curve.time_s.back(), plot_bands(report.curve),
        gnuplot_text(starts.empty() ? "measured mean" : "measured mean of " + starts));
    return figure;
}

}  // namespace stopline
