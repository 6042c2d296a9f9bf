// Figures of the trajectories on the first lane: time-space diagram, and speed and gap of some vehicles of the platoon.
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "base/units.h"
#include "figures/single_light_figures.h"
#include "scenario/fleets.h"

namespace stopline {

namespace {

// Numbers of the first approach lane and of its exit lane (see make_approach).
constexpr int kApproachLane = 0;
constexpr int kExitLane = 1;

std::vector<std::size_t> shown_populations(const SingleLightReport& result) {
    if (result.populations.size() < 2) return {0};
    if (!result.baseline) return {0, 1};
    return {*result.baseline == 0 ? std::size_t{1} : std::size_t{0}, *result.baseline};
}

// Returns the end of the time axis, in s after the start of green: 40 s, or less if the run or the recorded
// trajectories end earlier.
double trajectories_end_s(const SingleLightReport& result) {
    constexpr double kShown_s = 40.0;
    const double run_s = result.scenario.duration_s - result.scenario.signal.first_green_s;
    return std::min({kShown_s, run_s, result.scenario.signal.green_s + kTrajectoryAfter_s});
}

// Returns the trajectory points that the figure shows, by vehicle. They lie on the first approach lane or on its exit
// lane. The vehicles are ordered from the front of the queue.
std::vector<std::pair<int, std::vector<TrajectoryPoint>>> by_vehicle(const SingleLightReport& result,
                                                                     std::size_t population, double interval_s) {
    const RunResult& run = result.runs[population];
    std::map<int, std::vector<TrajectoryPoint>> vehicles;
    for (TrajectoryPoint point : thin_out(run.trajectory, interval_s, result.scenario.tick_s())) {
        if (point.lane != kApproachLane && point.lane != kExitLane) continue;
        point.time_s -= run.green_start_s;
        if (point.time_s > trajectories_end_s(result)) continue;
        point.distance_m -= result.scenario.network.approach.length_m;
        vehicles[point.vehicle].push_back(point);
    }
    std::vector<std::pair<int, std::vector<TrajectoryPoint>>> ordered(vehicles.begin(), vehicles.end());
    std::stable_sort(ordered.begin(), ordered.end(), [](const auto& a, const auto& b) {
        return a.second.front().distance_m > b.second.front().distance_m;
    });
    return ordered;
}

// Returns the commands that draw the light along the stop line from `from_s` to `to_s`. Dashes and words distinguish
// the lights even without colours.
std::string light_line(const std::string& light, double from_s, double to_s) {
    const bool green = light == "green";
    const std::string colour = green ? "#009E73" : light == "red" ? "#D55E00" : "#F0C000";
    const std::string words = green ? "#00694D" : light == "red" ? "#B34F00" : "#7A6200";
    std::string text = fmt::format("set arrow from {:.6g},0 to {:.6g},0 nohead lc rgb '{}' lw {} dt {} front\n", from_s,
                                   to_s, colour, green ? 3 : 5, green ? "(8,4)" : "1");
    if (!green) {
        text += fmt::format("set label '{}' at {:.6g},14 center tc rgb '{}' font ',12' front boxed\n", light,
                            0.5 * (from_s + to_s), words);
    }
    return text;
}

// Returns the commands that draw the signal over time: red, then green, yellow and red. If the signal has a cycle time,
// green, yellow and red repeat in every cycle.
std::string signal_lines(const SingleLightReport& result) {
    const SignalSettings& signal = result.scenario.signal;
    const double end_s = trajectories_end_s(result);
    const double cycle_s = signal.cycle_s > 0.0 ? signal.cycle_s : end_s + signal.green_s + signal.yellow_s;
    std::string text = light_line("red", -kTrajectoryBefore_s, 0.0);
    for (int cycle = 0; cycle * cycle_s < end_s; ++cycle) {
        const double begin_s = cycle * cycle_s;
        const double yellow_s = begin_s + signal.green_s;
        const double red_s = yellow_s + signal.yellow_s;
        text += light_line("green", begin_s, std::min(yellow_s, end_s));
        if (yellow_s < end_s && red_s > yellow_s) text += light_line("yellow", yellow_s, std::min(red_s, end_s));
        if (red_s < end_s) text += light_line("red", red_s, std::min(begin_s + cycle_s, end_s));
    }
    return text +
           "set label 'stop line' at graph 1.01, first 9 left tc rgb '#404040' font ',12'\n"
           "set label '(dashed: green)' at graph 1.01, first -9 left tc rgb '#00694D' font ',10'\n";
}

std::string time_space_data(const SingleLightReport& result, std::size_t population) {
    constexpr double kInterval_s = 0.5;
    const PopulationSettings& settings = result.scenario.populations[population];
    std::string text = "# time_s position_m policy queue_position, one block for each vehicle from the front\n";
    int position = 0;
    for (const auto& [vehicle, points] : by_vehicle(result, population, kInterval_s)) {
        ++position;
        for (const TrajectoryPoint& point : points) {
            text += fmt::format("{:.2f} {:.2f} \"{}\" {}\n", point.time_s, point.distance_m,
                                component_name(settings.components[static_cast<std::size_t>(point.policy)]), position);
        }
        text += "\n";  // an empty line interrupts the curve
    }
    return text;
}

std::string time_space_panel(const SingleLightReport& result, std::size_t population, const std::string& file) {
    constexpr int kBoldInterval = 10;  // every tenth vehicle is drawn bold
    const std::string colour = line_style(style_index(result, population)).colour;
    return fmt::format("set title {} offset 0,-0.6\n", gnuplot_text(result.populations[population].name)) +
           fmt::format(
               "plot '{0}' using 1:2 with lines dt 1 lc rgb '{1}' lw 0.8 notitle, \\\n"
               " '{0}' using 1:(int($4) % {2} == 0 ? $2 : NaN) with lines dt 1 lc rgb '{1}' lw 2.6 notitle\n",
               file, colour, kBoldInterval);
}

// Returns the queue positions that get a curve: dense at the front, sparse behind.
std::vector<std::size_t> shown_positions(std::size_t vehicles) {
    std::vector<std::size_t> positions;
    for (const std::size_t position : {1U, 2U, 3U, 5U, 10U, 15U, 20U, 30U}) {
        if (position <= vehicles) positions.push_back(position);
    }
    return positions;
}

std::string platoon_data(const SingleLightReport& result, std::size_t population) {
    std::string text = "# time_s speed_kmh net_gap_m, one block for each vehicle\n";
    const auto vehicles = by_vehicle(result, population, result.sample_interval_s);
    for (const std::size_t position : shown_positions(vehicles.size())) {
        text += fmt::format("# position {} in the queue\n", position);
        for (const TrajectoryPoint& point : vehicles[position - 1].second) {
            const std::string gap = std::isnan(point.net_gap_m) ? "NaN" : fmt::format("{:.3f}", point.net_gap_m);
            text += fmt::format("{:.2f} {:.3f} {}\n", point.time_s, point.speed_mps * kKmhPerMps, gap);
        }
        text += "\n\n";
    }
    return text;
}

std::string platoon_panel(const std::string& file, std::size_t curves, int column,
                          const std::vector<std::size_t>& titles) {
    // Column 3 is the net gap. The platoon leader has no gap, so the gap panel does not show its curve.
    if (column == 3 && curves < 2) return "plot NaN notitle\n";
    std::string text = "plot";
    for (std::size_t k = column == 3 ? 1 : 0; k < curves; ++k) {
        const std::string title = titles.empty() ? "notitle" : fmt::format("title '{}'", titles[k]);
        text += fmt::format(" '{}' index {} using 1:{} with lines dt 1 lw 1.8 lc rgb '{}' {},", file, k, column,
                            ordered_colour(k, curves), title);
    }
    text.back() = '\n';
    return text;
}

double largest_gap_shown_m(const SingleLightReport& result, const std::vector<std::size_t>& populations) {
    double largest_m = 0.0;
    for (const std::size_t population : populations) {
        const auto vehicles = by_vehicle(result, population, 0.5);
        for (const std::size_t position : shown_positions(vehicles.size())) {
            for (const TrajectoryPoint& point : vehicles[position - 1].second) {
                if (point.net_gap_m > largest_m) largest_m = point.net_gap_m;
            }
        }
    }
    return largest_m;
}

}  // namespace

Figure time_space_figure(const SingleLightReport& result) {
    constexpr double kBefore_m = 200.0;
    constexpr double kBehind_m = 150.0;
    const std::vector<std::size_t> populations = shown_populations(result);
    Figure figure;
    figure.name = "time_space";
    figure.height_px = populations.size() == 2 ? 860 : 480;
    figure.body = fmt::format("set multiplot layout {},1 title {} font ',15'\n", populations.size(),
                              gnuplot_text("Trajectories of the vehicle fronts (every tenth vehicle bold)")) +
                  fmt::format("set xrange [-{:.6g}:{:.6g}]\nset yrange [-{}:{}]\n", kTrajectoryBefore_s,
                              trajectories_end_s(result), kBefore_m, kBehind_m) +
                  "set xlabel 'time since the start of green [s]'\nset ylabel 'distance from the stop line [m]'\n" +
                  "set xtics 5\nset ytics 50\nset rmargin 14\n" + signal_lines(result);
    for (std::size_t k = 0; k < populations.size(); ++k) {
        const std::string file = fmt::format("time_space_{}.dat", k + 1);
        figure.data.emplace_back(file, time_space_data(result, populations[k]));
        figure.body += time_space_panel(result, populations[k], file);
    }
    figure.body += "unset multiplot\n";
    return figure;
}

Figure platoon_figure(const SingleLightReport& result) {
    const std::vector<std::size_t> populations = shown_populations(result);
    const double limit_kmh = result.scenario.network.approach.speed_limit_mps * kKmhPerMps;
    const double gap_m = 1.05 * std::max(1.0, largest_gap_shown_m(result, populations));
    Figure figure;
    figure.name = "platoon";
    figure.height_px = 720;
    figure.body = fmt::format(
                      "set multiplot layout 2,{} columnsfirst margins 0.08,0.87,0.09,0.88 spacing 0.1,0.1 "
                      "title 'Speed and gap of some vehicles of the queue' font ',15'\n",
                      populations.size()) +
                  fmt::format("set xrange [0:{:.6g}]\nset xtics 10\n", trajectories_end_s(result));
    for (std::size_t k = 0; k < populations.size(); ++k) {
        const std::string file = fmt::format("platoon_{}.dat", k + 1);
        const std::vector<std::size_t> positions =
            shown_positions(by_vehicle(result, populations[k], result.sample_interval_s).size());
        figure.data.emplace_back(file, platoon_data(result, populations[k]));
        // All panels share one legend on the right.
        const bool last = k + 1 == populations.size();
        figure.body +=
            (last ? "set key at screen 0.99,0.88 right top title 'queue position'\n" : "unset key\n") +
            fmt::format("set title {} offset 0,-0.6\n", gnuplot_text(result.populations[populations[k]].name)) +
            fmt::format("set yrange [0:{:.6g}]\nset xlabel ''\nset ylabel 'speed [km/h]'\n", 1.12 * limit_kmh) +
            platoon_panel(file, positions.size(), 2, positions) +
            fmt::format("unset key\nset title ''\nset yrange [0:{:.6g}]\n", gap_m) +
            "set xlabel 'time since the start of green [s]'\nset ylabel 'net gap [m]'\n" +
            platoon_panel(file, positions.size(), 3, {});
    }
    figure.body += "unset multiplot\n";
    return figure;
}

}  // namespace stopline
