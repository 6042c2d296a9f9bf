#include "figures/street_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "scenario/make_network.h"
#include "sim/state/model.h"

namespace stopline {

namespace {

constexpr double kRow_m = 560.0;    // longest part of the corridor in one row of the figure
constexpr double kRow_px = 1520.0;  // width of one row of the figure
// Drawn length of a leg to the border of the network, from the centre of its intersection: major and minor street.
constexpr double kMajorLeg_m = 130.0;
constexpr double kMinorLeg_m = 55.0;
constexpr double kBelow_m = 57.0;      // drawn height below the centre of the southernmost intersection
constexpr double kAbove_m = 95.0;      // drawn height above the centre of the northernmost intersection
constexpr double kBarLength_m = 60.0;  // length of a bar that shows a signal cycle
constexpr double kBarHeight_m = 4.0;

// Returns the point `ahead_m` beyond the end of the lane, in driving direction, and `right_m` to the right.
Point beside(const Lane& lane, double ahead_m, double right_m) {
    const Pose pose = pose_at(lane.shape, length_m(lane.shape) + ahead_m);
    return {pose.point.x_m + right_m * pose.sine, pose.point.y_m - right_m * pose.cosine};
}

std::string line_of(const Polyline& points) {
    std::string text;
    for (const Point& p : points) text += fmt::format("{:.2f} {:.2f}\n", p.x_m, p.y_m);
    return text + "\n";
}

// Returns the outline of a lane with this centre line and half width.
Polyline band(const Polyline& line, double half_m) {
    Polyline right;
    Polyline left;
    for (std::size_t k = 0; k < line.size(); ++k) {
        const Point& from = line[k == 0 ? 0 : k - 1];
        const Point& to = line[std::min(k + 1, line.size() - 1)];
        const double dx = to.x_m - from.x_m;
        const double dy = to.y_m - from.y_m;
        const double share = half_m / std::hypot(dx, dy);
        right.push_back({line[k].x_m + share * dy, line[k].y_m - share * dx});
        left.push_back({line[k].x_m - share * dy, line[k].y_m + share * dx});
    }
    right.insert(right.end(), left.rbegin(), left.rend());
    right.push_back(right.front());
    return right;
}

// Returns the drawn part of a lane outside the intersections. Lanes from or to the border of the network are shortened.
Polyline shown_part(const LaneGraph& graph, int number, double radius_m) {
    const Lane& lane = graph.lanes[at(number)];
    const bool minor = std::abs(lane.shape.front().x_m - lane.shape.back().x_m) <
                       std::abs(lane.shape.front().y_m - lane.shape.back().y_m);
    const double near_m = (minor ? kMinorLeg_m : kMajorLeg_m) - radius_m;
    const double whole_m = length_m(lane.shape);
    const bool exit = lane.signal_group < 0;
    const bool entry = std::find(graph.entries.begin(), graph.entries.end(), number) != graph.entries.end();
    const double cut_m = exit || entry ? std::max(whole_m - near_m, 0.0) : 0.0;
    return {pose_at(lane.shape, exit ? 0.0 : cut_m).point, pose_at(lane.shape, exit ? whole_m - cut_m : whole_m).point};
}

// Returns the radius of the intersection from which an exit lane starts. This is the intersection nearest to the start
// of the lane.
double radius_behind_m(const StreetSettings& streets, const Lane& exit) {
    const auto apart_m = [&](const StreetIntersection& node) {
        return std::hypot(node.x_m - exit.shape.front().x_m, node.y_m - exit.shape.front().y_m);
    };
    const auto& nodes = streets.intersections;
    return std::min_element(nodes.begin(), nodes.end(),
                            [&](const auto& a, const auto& b) { return apart_m(a) < apart_m(b); })
        ->radius_m;
}

// The contents of the data files of the map.
struct MapData {
    std::string inside = "# x_m y_m, surfaces of connections inside intersections\n";
    std::string lanes = "# x_m y_m, surfaces of lanes\n";
    std::string pockets = "# x_m y_m, surfaces of pockets\n";
    std::string stems = "# x_m y_m, stems of arrows\n";
    std::string heads = "# x_m y_m, heads of arrows\n";
    std::array<std::string, 3> lines{"# x_m y_m, stop lines\n", "# x_m y_m, stop lines\n", "# x_m y_m, stop lines\n"};
};

// Adds the direction arrows of a lane. The arrows are long and as wide as the lane. Smaller arrows would be illegible,
// because a lane is only a few pixels wide.
void add_arrow(const LaneGraph& graph, const Lane& lane, MapData& drawn) {
    constexpr double kBegin_m = -29.0;
    constexpr double kBend_m = -19.0;
    for (const int next : lane.next) {
        const Turn turn = graph.lanes[at(next)].turn;
        const double side = turn == Turn::right ? 1.0 : turn == Turn::left ? -1.0 : 0.0;
        if (turn == Turn::straight) {
            drawn.stems += line_of({beside(lane, kBegin_m, 0.0), beside(lane, -10.0, 0.0)});
            drawn.heads += line_of({beside(lane, -11.0, -1.2), beside(lane, -3.0, 0.0), beside(lane, -11.0, 1.2),
                                    beside(lane, -11.0, -1.2)});
            continue;
        }
        // The arrow of a lane with a single movement is wider.
        const double stem_m = lane.next.size() == 1 ? -0.9 * side : 0.0;
        const double neck_m = lane.next.size() == 1 ? -0.2 * side : 0.3 * side;
        drawn.stems += line_of(
            {beside(lane, kBegin_m, stem_m), beside(lane, kBend_m, stem_m), beside(lane, kBend_m + 2.5, neck_m)});
        drawn.heads += line_of({beside(lane, kBend_m - 1.5, neck_m), beside(lane, kBend_m + 6.5, neck_m),
                                beside(lane, kBend_m + 2.5, 1.65 * side), beside(lane, kBend_m - 1.5, neck_m)});
    }
}

MapData draw_lanes(const StreetSettings& streets, const NetworkSettings& network, const LaneGraph& graph) {
    // Half width of a drawn lane as a share of the lane width. The space between two drawn lanes looks like a line.
    constexpr double kHalfWidth = 0.46;
    const double half_m = kHalfWidth * streets.lane_width_m;
    MapData drawn;
    for (int number = 0; number < static_cast<int>(graph.lanes.size()); ++number) {
        const Lane& lane = graph.lanes[at(number)];
        if (lane.origin >= 0) {
            drawn.inside += line_of(band(lane.shape, 0.55 * streets.lane_width_m));
            continue;
        }
        const double radius_m =
            lane.signal_group >= 0 ? radius_beyond_m(network, lane) : radius_behind_m(streets, lane);
        (lane.start_offset_m > 0.0 ? drawn.pockets : drawn.lanes) +=
            line_of(band(shown_part(graph, number, radius_m), half_m));
        if (lane.signal_group < 0) continue;
        add_arrow(graph, lane, drawn);
        const Polyline line{beside(lane, -0.7, -half_m), beside(lane, -0.7, half_m)};
        drawn.lines[at(lane.signal_group % 3)] += line_of(line);
    }
    return drawn;
}

// Bars that show the signals over a cycle, one bar for each signal group. A bar consists of rectangles in the colours
// of the lights.
struct Bars {
    std::array<std::string, 3> by_light{"# x_m y_m, red\n", "# x_m y_m, green\n", "# x_m y_m, yellow\n"};
};

// Returns for each signal group of an intersection whether it controls a lane. The groups are the major street, its
// left turns, and the minor street.
std::array<bool, 3> used_groups(const LaneGraph& graph, std::size_t node) {
    std::array<bool, 3> used{};
    for (const Lane& lane : graph.lanes) {
        if (lane.signal_group < 0 || at(lane.signal_group / 3) != node) continue;
        used[at(lane.signal_group % 3)] = true;
    }
    return used;
}

double top_of_bar_m(const StreetIntersection& node, int number) {
    return node.y_m + kAbove_m - 18.0 - 1.35 * kBarHeight_m * number;
}

void add_bars(const StreetIntersection& node, const std::array<bool, 3>& used, Bars& bars) {
    constexpr double kTick_s = 0.1;
    const double m_per_tick = kBarLength_m / (node.programme.cycle_s() / kTick_s);
    int number = 0;
    std::size_t group = 0;
    for (const GroupProgramme& programme : make_seven_steps(node.programme, node.offset_s, kTick_s)) {
        if (!used[group++]) continue;
        const double row_m = top_of_bar_m(node, number++);
        std::int64_t from = 0;
        for (std::int64_t tick = 1; tick <= programme.cycle_ticks(); ++tick) {
            const Light light = programme.light(from);
            if (tick < programme.cycle_ticks() && programme.light(tick) == light) continue;
            const double inset_m = light == Light::red ? 0.35 * kBarHeight_m : 0.0;  // red is drawn as a thin line
            const double x0 = node.x_m - 0.5 * kBarLength_m + static_cast<double>(from) * m_per_tick;
            const double x1 = node.x_m - 0.5 * kBarLength_m + static_cast<double>(tick) * m_per_tick;
            bars.by_light[static_cast<std::size_t>(light)] += line_of({{x0, row_m - inset_m},
                                                                       {x1, row_m - inset_m},
                                                                       {x1, row_m - kBarHeight_m + inset_m},
                                                                       {x0, row_m - kBarHeight_m + inset_m},
                                                                       {x0, row_m - inset_m}});
            from = tick;
        }
    }
}

struct MapRow {
    double from_m;
    double to_m;
};

// Splits the corridor into rows of limited length. No split cuts an intersection.
std::vector<MapRow> rows_of(const StreetSettings& streets) {
    std::vector<double> centres_m;
    for (const StreetIntersection& node : streets.intersections) centres_m.push_back(node.x_m);
    std::sort(centres_m.begin(), centres_m.end());
    const double first_m = centres_m.front() - kMajorLeg_m - 10.0;
    const double whole_m = centres_m.back() + kMajorLeg_m + 10.0 - first_m;
    if (whole_m <= kRow_m) return {{first_m, first_m + whole_m}};
    constexpr double kFree_m = 60.0;  // a row must continue this far beyond the centres of its intersections
    std::vector<MapRow> rows{{first_m, first_m + kRow_m}};
    for (std::size_t k = 0; k < centres_m.size(); ++k) {
        if (centres_m[k] + kFree_m <= rows.back().to_m) continue;
        const double before_m = k == 0 ? first_m : 0.5 * (centres_m[k - 1] + centres_m[k]);
        const double from_m = std::max(before_m, centres_m[k] - 0.5 * kRow_m);
        rows.back().to_m = std::min(rows.back().to_m, from_m);
        rows.push_back({from_m, from_m + kRow_m});
    }
    rows.back().to_m = std::min(rows.back().to_m, first_m + whole_m);
    return rows;
}

struct Span {
    double low_m = std::numeric_limits<double>::infinity();
    double high_m = -std::numeric_limits<double>::infinity();
};

// Returns the commands that label each bar with its signal group.
std::string bar_labels(const StreetIntersection& node, const std::array<bool, 3>& used) {
    constexpr std::array<const char*, 3> kNames{"major", "left", "minor"};
    std::string text;
    int number = 0;
    for (std::size_t group = 0; group < kNames.size(); ++group) {
        if (!used[group]) continue;
        text += fmt::format("set label '{}' at {:.1f},{:.1f} right front font ',9'\n", kNames[group],
                            node.x_m - 0.5 * kBarLength_m - 2.0, top_of_bar_m(node, number++) - 0.5 * kBarHeight_m);
    }
    return text;
}

std::string labels_of(const StreetSettings& streets, const LaneGraph& graph, const MapRow& row) {
    std::string text = "unset label\n";
    for (std::size_t n = 0; n < streets.intersections.size(); ++n) {
        const StreetIntersection& node = streets.intersections[n];
        if (node.x_m < row.from_m || node.x_m > row.to_m) continue;
        std::string name = node.name;
        std::replace(name.begin(), name.end(), '_', ' ');
        std::string steps;
        for (const double step_s : node.programme.steps_s())
            steps += fmt::format("{}{:g}", steps.empty() ? "" : "/", step_s);
        text += fmt::format("set label {} at {:.1f},{:.1f} center front boxed\n", gnuplot_text(name), node.x_m,
                            node.y_m + kAbove_m - 6.0);
        text += fmt::format("set label {} at {:.1f},{:.1f} center front boxed font ',10' tc rgb '#555555'\n",
                            gnuplot_text(fmt::format("{} s, offset {:g} s", steps, node.offset_s)), node.x_m,
                            node.y_m + kAbove_m - 13.5);
        text += bar_labels(node, used_groups(graph, n));
    }
    return text;
}

std::string plots() {
    std::string text =
        "plot 'network_inside.dat' with filledcurves closed fc rgb '#c4c4c4' notitle, 'network_lanes.dat' with filledcurves "
        "closed fc rgb '#9a9a9a' notitle, 'network_pockets.dat' with filledcurves closed fc rgb '#7d8aa0' title 'turn pocket'";
    text +=
        ", 'network_stems.dat' with lines lc rgb 'white' lw 2.5 dt 1 notitle, 'network_heads.dat' with filledcurves closed fc "
        "rgb 'white' notitle";
    const std::array<std::array<const char*, 2>, 3> groups{{{"#0072b2", "stop line of the major street"},
                                                            {"#cc79a7", "stop line of protected left turns"},
                                                            {"#d55e00", "stop line of the minor street"}}};
    for (std::size_t k = 0; k < groups.size(); ++k) {
        text += fmt::format(", 'network_lines_{}.dat' with lines lc rgb '{}' lw 3 dt 1 title '{}'", k, groups[k][0],
                            groups[k][1]);
    }
    const std::array<std::array<const char*, 2>, 3> lights{
        {{"#222222", "red (thin line)"}, {"#009e73", "green, cycle from 0 s"}, {"#f0e442", "yellow"}}};
    for (std::size_t k = 0; k < lights.size(); ++k) {
        text += fmt::format(", 'network_light_{}.dat' with filledcurves closed fc rgb '{}' title '{}'", k, lights[k][0],
                            lights[k][1]);
    }
    return text + "\n";
}

}  // namespace

Figure street_map(const Scenario& scenario) {
    const StreetSettings& streets = scenario.network.streets;
    const LaneGraph graph = make_streets(streets);
    const MapData drawn = draw_lanes(streets, scenario.network, graph);
    Bars bars;
    Span span;
    for (std::size_t n = 0; n < streets.intersections.size(); ++n) {
        const StreetIntersection& node = streets.intersections[n];
        add_bars(node, used_groups(graph, n), bars);
        span.low_m = std::min(span.low_m, node.y_m - kBelow_m);
        span.high_m = std::max(span.high_m, node.y_m + kAbove_m);
    }
    Figure figure;
    figure.name = "network";
    figure.data = {{"network_inside.dat", drawn.inside},
                   {"network_lanes.dat", drawn.lanes},
                   {"network_pockets.dat", drawn.pockets},
                   {"network_stems.dat", drawn.stems},
                   {"network_heads.dat", drawn.heads}};
    for (std::size_t k = 0; k < 3; ++k) {
        figure.data.emplace_back(fmt::format("network_lines_{}.dat", k), drawn.lines[k]);
        figure.data.emplace_back(fmt::format("network_light_{}.dat", k), bars.by_light[k]);
    }
    const std::vector<MapRow> rows = rows_of(streets);
    constexpr double kHead_px = 90.0;
    constexpr double kAxis_px = 44.0;
    constexpr double kFoot_px = 20.0;
    constexpr double kSide_px = 40.0;
    const double px_per_m = kRow_px / std::min(kRow_m, rows.back().to_m - rows.front().from_m);
    const double row_px = px_per_m * (span.high_m - span.low_m);
    const double height_px = kHead_px + static_cast<double>(rows.size()) * (row_px + kAxis_px) + kFoot_px;
    const double width_px = kRow_px + 2.0 * kSide_px;
    figure.width_px = static_cast<int>(width_px);
    figure.height_px = static_cast<int>(height_px);
    figure.body = fmt::format(
        "set multiplot\nunset ytics\nunset xlabel\nset border 1\nunset grid\nset style fill solid 1.0 noborder\nset yrange "
        "[{:.1f}:{:.1f}]\nset xtics 100\nset mxtics 2\nset lmargin at screen {:.5f}\n",
        span.low_m, span.high_m, kSide_px / width_px);
    for (std::size_t k = 0; k < rows.size(); ++k) {
        const MapRow& row = rows[k];
        const double top_px = kHead_px + static_cast<double>(k) * (row_px + kAxis_px);
        figure.body += fmt::format(
            "set rmargin at screen {:.5f}\nset tmargin at screen {:.5f}\nset bmargin at screen {:.5f}\nset xrange [{:.1f}:{:.1f}]\n",
            (kSide_px + px_per_m * (row.to_m - row.from_m)) / width_px, 1.0 - top_px / height_px,
            1.0 - (top_px + row_px) / height_px, row.from_m, row.to_m);
        if (k == 0)
            figure.body +=
                fmt::format("set key at screen 0.98,{:.5f} right top horizontal maxcols 6\n", 1.0 - 8.0 / height_px);
        if (k == 1) figure.body += "unset key\n";
        if (k + 1 == rows.size()) figure.body += "set xlabel 'position to the east [m]'\n";
        figure.body += labels_of(streets, graph, row) + plots();
    }
    figure.body += "unset multiplot\n";
    return figure;
}

}  // namespace stopline
