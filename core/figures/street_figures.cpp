#include "figures/street_figures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "figures/interval_points.h"
#include "figures/population_style.h"
#include "runs/network/street_results.h"

namespace stopline {

namespace {

// Returns the inflow from west, from east and from the crossing streets over time, veh/min.
std::string inflow_data(const NetworkResult& f, double interval_s) {
    std::string text = "# minutes west east crossing\n";
    const std::size_t group = intervals_per_point(f.inflow.size());
    for (std::size_t k = 0; k + group <= f.inflow.size(); k += group) {
        std::array<double, 4> sum{};
        for (std::size_t i = k; i < k + group; ++i) {
            for (std::size_t side = 0; side < sum.size(); ++side) sum[side] += f.inflow[i][side];
        }
        const double minutes = static_cast<double>(group) * interval_s / 60.0;
        text +=
            fmt::format("{:.2f} {:.3f} {:.3f} {:.3f}\n", (static_cast<double>(k) * interval_s) / 60.0 + 0.5 * minutes,
                        sum[0] / minutes, sum[2] / minutes, (sum[1] + sum[3]) / minutes);
    }
    return text;
}

std::string map_data(const std::vector<std::vector<double>>& mps, double from_m, double interval_s) {
    std::string text = "# minutes metres km/h\n";
    for (std::size_t k = 0; k < mps.size(); ++k) {
        for (std::size_t stretch = 0; stretch < mps[k].size(); ++stretch) {
            const double speed_mps = mps[k][stretch];
            const double metres = from_m + (static_cast<double>(stretch) + 0.5) * SpeedMap::kStretch_m;
            text += fmt::format("{:.2f} {:.1f} {}\n", (static_cast<double>(k) + 0.5) * interval_s / 60.0, metres,
                                std::isnan(speed_mps) ? "NaN" : fmt::format("{:.1f}", 3.6 * speed_mps));
        }
    }
    return text;
}

}  // namespace

Figure inflow_figure(const NetworkReport& report) {
    Figure figure;
    figure.name = "inflow";
    figure.width_px = 900;
    figure.height_px = 720;
    std::string body = "set multiplot layout 3,1 margins 0.10,0.84,0.08,0.96 spacing 0.04\nset key outside right top\n";
    for (std::size_t k = 0; k < report.populations.size(); ++k) {
        figure.data.emplace_back(fmt::format("inflow_{}.dat", k),
                                 inflow_data(report.populations[k], report.scenario.measure.interval_s));
    }
    const double interval_s = report.scenario.measure.interval_s;
    const std::size_t intervals = report.populations.empty() ? 0 : report.populations[0].inflow.size();
    const std::size_t drawn = intervals / intervals_per_point(intervals);
    if (drawn == 0) figure.nothing = no_interval_text(report.scenario);
    body += fmt::format("set xrange [0:{:g}]\n", report.scenario.duration_s / 60.0);
    const std::array<const char*, 3> labels{"from the west", "from the east", "crossing streets"};
    for (std::size_t panel = 0; panel < labels.size(); ++panel) {
        const bool last = panel + 1 == labels.size();
        body += last ? fmt::format("set xlabel 'time [min]; points: {}'\nset format x '%g'\n",
                                   points_text(intervals, interval_s))
                     : "unset xlabel\nset format x ''\n";
        body += fmt::format("set ylabel '{} [veh/min]'\nset yrange [0:*]\n{}plot ", labels[panel],
                            panel == 0 ? "" : "unset key\n");
        for (std::size_t k = 0; k < report.populations.size(); ++k) {
            const LineStyle style = style_of(report.scenario, report.populations[k].population);
            body += fmt::format("{}'inflow_{}.dat' using 1:{} with {} lw 2 lc rgb '{}' dt {} title {}",
                                k == 0 ? "" : ", ", k, panel + 2, curve_style(drawn), style.colour, style.dash,
                                gnuplot_text(report.populations[k].population));
        }
        body += "\n";
    }
    figure.body = body + "unset multiplot\n";
    return figure;
}

Figure backlog_figure(const NetworkReport& report) {
    constexpr int kPanel_px = 210;
    const std::size_t rows = report.populations.size();
    Figure figure;
    figure.name = "backlog";
    figure.width_px = 1000;
    figure.height_px = static_cast<int>(rows) * kPanel_px + 115;
    std::string body =
        fmt::format("set multiplot layout {},2 margins 0.10,0.90,{:.4f},{:.4f} spacing 0.03,{:.4f}\n", rows,
                    85.0 / figure.height_px, 1.0 - 40.0 / figure.height_px, 32.0 / figure.height_px);
    body += fmt::format(
        "set label 'White: no vehicle on the lanes toward an intersection in this interval.' at screen 0.5,{:.4f} center font ',11' tc rgb '#404040'\n",
        16.0 / figure.height_px);
    body += "unset key\nset xrange [0:*]\nset autoscale yfix\nset cbrange [0:50]\n";
    // Viridis: dark is slow, light is fast. It is readable in grey print and for colour-blind readers.
    body += "set palette defined (0 '#440154', 12 '#3b528b', 24 '#21908d', 37 '#5dc963', 50 '#fde725')\n";
    for (std::size_t k = 0; k < rows; ++k) {
        const Congestion& backlog = report.populations[k].congestion;
        if (backlog.map.eastwards_mps.size() < 2)
            figure.nothing = "the speed map needs two whole intervals (measure.interval)";
        figure.data.emplace_back(fmt::format("backlog_{}_east.dat", k),
                                 map_data(backlog.map.eastwards_mps, backlog.map.from_m, backlog.interval_s));
        figure.data.emplace_back(fmt::format("backlog_{}_west.dat", k),
                                 map_data(backlog.map.westwards_mps, backlog.map.from_m, backlog.interval_s));
        const bool last = k + 1 == rows;
        body += last ? "set xlabel 'time [min]'\nset format x '%g'\n" : "unset xlabel\nset format x ''\n";
        for (const bool east : {true, false}) {
            body += fmt::format("set title {} offset 0,-0.8\n", gnuplot_text(report.populations[k].population +
                                                                             (east ? ", eastbound" : ", westbound")));
            body += east ? "set ylabel 'position to the east [m]'\nset format y '%g'\nunset colorbox\n"
                         : "unset ylabel\nset format y ''\nset colorbox\nset cblabel 'mean speed [km/h]'\n";
            body += fmt::format("plot 'backlog_{}_{}.dat' using 1:2:3 with image\n", k, east ? "east" : "west");
            if (k == 0 && east) body += "unset label\n";  // else gnuplot draws the label again in each panel
        }
    }
    figure.body = body + "unset multiplot\n";
    return figure;
}

}  // namespace stopline
