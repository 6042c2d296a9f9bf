#include "figures/intersection_figures.h"
#include "scenario/fleets.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "scenario/make_network.h"
namespace stopline {

namespace {

std::string lanes_data(const LaneGraph& graph) {
    std::string text = "# x_m y_m, one block for each lane\n";
    for (const Lane& lane : graph.lanes) {
        for (const Point& p : lane.shape) text += fmt::format("{:.3f} {:.3f}\n", p.x_m, p.y_m);
        text += "\n\n";
    }
    return text;
}

std::string stop_lines_data(const LaneGraph& graph, double half_width_m) {
    std::string text = "# x_m y_m dx_m dy_m signal_group\n";
    for (const Lane& lane : graph.lanes) {
        if (lane.signal_group < 0) continue;
        const Pose pose = pose_at(lane.shape, lane.stop_line_m);
        const double x_m = pose.point.x_m + half_width_m * pose.sine;
        const double y_m = pose.point.y_m - half_width_m * pose.cosine;
        text += fmt::format("{:.3f} {:.3f} {:.3f} {:.3f} {}\n", x_m, y_m, -2.0 * half_width_m * pose.sine,
                            2.0 * half_width_m * pose.cosine, lane.signal_group);
    }
    return text;
}

std::string vehicles_data(const std::vector<DrawnVehicle>& vehicles, int policy) {
    std::string text = "# rear x_m y_m, front minus rear dx_m dy_m\n";
    bool found = false;
    for (const DrawnVehicle& v : vehicles) {
        if (v.policy != policy) continue;
        found = true;
        text += fmt::format("{:.3f} {:.3f} {:.3f} {:.3f}\n", v.rear.x_m, v.rear.y_m, v.front.x_m - v.rear.x_m,
                            v.front.y_m - v.rear.y_m);
    }
    return found ? text : text + "NaN NaN NaN NaN\n";
}

// Colours of the lights in the order of the enum Light: red, green, yellow.
constexpr std::array<const char*, 3> kLightColours{"#d55e00", "#009e73", "#e69f00"};

}  // namespace

Figure intersection_picture(const IntersectionReport& report, std::size_t population) {
    const Scenario& scenario = report.scenario;
    const IntersectionResult& figures = report.populations[population];
    const IntersectionSettings& layout = scenario.network.intersection;
    LaneGraph graph = make_intersection(layout);
    assign_phase_groups(scenario, graph);
    Figure figure;
    figure.name = "intersection";
    figure.width_px = figure.height_px = 900;
    figure.data = {{"intersection_lanes.dat", lanes_data(graph)},
                   {"intersection_stop_lines.dat", stop_lines_data(graph, 0.45 * layout.lane_width_m)}};
    const auto& components = scenario.populations[population].components;
    for (std::size_t k = 0; k < components.size(); ++k) {
        figure.data.emplace_back(fmt::format("intersection_vehicles_{}.dat", k),
                                 vehicles_data(figures.snapshot, static_cast<int>(k)));
    }
    const std::size_t populations = report.populations.size();
    const std::string others = populations > 1 ? fmt::format(" (one of {} populations)", populations) : "";
    const double shown_m = layout.radius_m + std::min({layout.approach_length_m, layout.exit_length_m, 80.0});
    figure.body = fmt::format(
        "set title {0}\nset size ratio -1\nunset grid\nset xlabel 'distance east of the centre [m]'\nset ylabel 'distance north of the "
        "centre [m]'\nset xrange [-{1:.6g}:{1:.6g}]\nset yrange [-{1:.6g}:{1:.6g}]\nset key outside above center horizontal "
        "maxcols 4\n",
        gnuplot_text(fmt::format("Population {}{}, {:.0f} s after the start of the run", figures.population, others,
                                 figures.snapshot_s)),
        shown_m);
    for (std::size_t k = 0; k < scenario.measure.zone_radius_m.size(); ++k) {
        figure.body += fmt::format("set object {} circle at 0,0 size {:.6g} fs empty border lc rgb '#999999' dt 3\n",
                                   k + 1, scenario.measure.zone_radius_m[k]);
    }
    figure.body += fmt::format(
        "plot 'intersection_lanes.dat' with lines lc rgb '#dddddd' lw {:.6g} notitle, 'intersection_lanes.dat' with lines lc "
        "rgb '#bbbbbb' lw 0.5 dt 2 notitle",
        9.0);
    for (std::size_t group = 0; group < figures.snapshot_lights.size(); ++group) {
        figure.body += fmt::format(
            ", 'intersection_stop_lines.dat' using 1:2:($5=={0}?$3:NaN):4 with vectors nohead lw 4 lc rgb '{1}' notitle",
            group, kLightColours[static_cast<std::size_t>(figures.snapshot_lights[group])]);
    }
    for (std::size_t k = 0; k < components.size(); ++k) {
        figure.body += fmt::format(
            ", 'intersection_vehicles_{}.dat' with vectors head filled size 1.2,18 lw 5 lc rgb '{}' title {}", k,
            // The spaces keep the arrow head off the text.
            line_style(2 * k).colour, gnuplot_text("  " + component_name(components[k])));
    }
    figure.body += "\n";
    return figure;
}

namespace {

// The mean headway at one queue position.
struct PositionHeadway {
    double headway_s = 0.0;
    int samples = 0;
};

// Returns the mean headways by queue position, over all lanes with saturated greens (greens that start with a queue of
// at least five vehicles). The list ends before the first position that the queue of one of these lanes never reaches.
// From this position on, the mean would cover only the lanes with long queues.
std::vector<PositionHeadway> common_positions(const Discharge& discharge) {
    std::vector<PositionHeadway> positions;
    for (std::size_t n = 0;; ++n) {
        PositionHeadway mean;
        for (const LaneDischarge& lane : discharge.lanes) {
            if (lane.saturated_greens == 0) continue;
            if (n >= lane.samples.size()) return positions;
            mean.headway_s += lane.headway_s[n] * lane.samples[n];
            mean.samples += lane.samples[n];
        }
        if (mean.samples == 0) return positions;
        mean.headway_s /= mean.samples;
        positions.push_back(mean);
    }
}

// Returns the mean headways by queue position, or nothing if no position has enough samples.
std::optional<Figure> headway_figure(const IntersectionReport& report) {
    constexpr int kMinSamples = 8;  // fewest headways from which a point of the figure is computed
    Figure figure;
    figure.name = "headways";
    std::string plots;
    double last = 0.0;
    for (std::size_t k = 0; k < report.populations.size(); ++k) {
        const IntersectionResult& f = report.populations[k];
        std::string text = "# position headway_s\n";
        bool found = false;
        const std::vector<PositionHeadway> positions = common_positions(f.discharge);
        for (std::size_t n = 0; n < positions.size(); ++n) {
            if (positions[n].samples < kMinSamples) continue;
            text += fmt::format("{} {:.4f}\n", n + 1, positions[n].headway_s);
            last = std::max(last, static_cast<double>(n + 1));
            found = true;
        }
        if (!found) text += "NaN NaN\n";
        const std::string file = fmt::format("headways_{}.dat", k);
        figure.data.emplace_back(file, text);
        plots += fmt::format("{}'{}' with linespoints lc rgb '{}' lw 2 pt {} ps 0.7 title {}", k == 0 ? "" : ", ", file,
                             ordered_colour(k, report.populations.size()), line_style(k).hollow_point,
                             gnuplot_text(f.population));
    }
    if (last == 0.0) return std::nullopt;
    figure.body = fmt::format(
        "set title 'Mean headway by position in the queue'\nset xlabel 'position in the queue (position 1: time from the start of green)'\nset "
        "ylabel 'headway at the stop line [s]'\nset xrange [0.5:{:.6g}]\nset yrange [0:*]\nset key outside right\nplot {}\n",
        last + 0.5, plots);
    return figure;
}

}  // namespace

std::vector<Figure> intersection_figures(const IntersectionReport& report) {
    // The picture shows the population with the most even mix of policies. The evenness is the smallest share of a
    // policy in the population, or 0 if the population has only one policy.
    const std::vector<PopulationSettings>& all = report.scenario.populations;
    std::size_t mixed = 0;
    double evenness = -1.0;
    for (std::size_t k = 0; k < all.size(); ++k) {
        double smallest = 1.0;
        for (const auto& component : all[k].components) smallest = std::min(smallest, component.share);
        const double own = all[k].components.size() > 1 ? smallest : 0.0;
        if (own > evenness) {
            evenness = own;
            mixed = k;
        }
    }
    std::vector<Figure> figures{intersection_picture(report, mixed)};
    if (std::optional<Figure> headways = headway_figure(report)) figures.push_back(*std::move(headways));
    return figures;
}

}  // namespace stopline
