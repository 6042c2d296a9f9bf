#include "experiment/time_space.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "experiment/csv.h"
#include "experiment/population_style.h"
#include "measure/area.h"

namespace stopline {

namespace {

constexpr double kSample_s = 1.0;

std::size_t at(int index) { return static_cast<std::size_t>(index); }

int straight_on(const LaneGraph& graph, int lane) {
    for (const int next : graph.lanes[at(lane)].next) {
        const Turn turn = graph.lanes[at(next)].turn;
        if (turn == Turn::straight || turn == Turn::none) return next;
    }
    return -1;
}

Side side_of(const std::string& name) {
    const auto found = std::find(kSideNames.begin(), kSideNames.end(), name);
    return static_cast<Side>(found - kSideNames.begin());
}

// Where a lane begins, from the middle towards the side.
double outwards_m(const Lane& lane, Side side) {
    const auto& begin = lane.shape[0];
    if (side == Side::west) return -begin.x_m;
    if (side == Side::east) return begin.x_m;
    return side == Side::south ? -begin.y_m : begin.y_m;
}

// "c0r2_west_in_": the name of a lane to an intersection without its number.
std::string inlet_of(const Lane& lane) { return lane.name.substr(0, lane.name.find_last_of('_') + 1); }

// Of the middle row or column of a grid.
std::string inlet_of_grid(const GridSettings& grid, const std::string& from) {
    int column = grid.columns / 2;
    int row = grid.rows / 2;
    if (from == "west") column = 0;
    if (from == "east") column = grid.columns - 1;
    if (from == "south") row = 0;
    if (from == "north") row = grid.rows - 1;
    const bool single = grid.columns == 1 && grid.rows == 1;  // its lanes have no place in their names
    return single ? from + "_in_" : fmt::format("c{}r{}_{}_in_", column, row, from);
}

// Of streets: where vehicles enter the network furthest out on that side and can go straight on.
std::string inlet_of_streets(const LaneGraph& graph, Side side) {
    const Lane* furthest = nullptr;
    for (const int entry : graph.entries) {
        const Lane& lane = graph.lanes[at(entry)];
        if (comes_from(lane) != side || straight_on(graph, entry) < 0) continue;
        if (furthest == nullptr || outwards_m(lane, side) >= outwards_m(*furthest, side)) furthest = &lane;
    }
    return furthest == nullptr ? "" : inlet_of(*furthest);
}

// A lane and those that follow it straight on.
struct StraightWay {
    std::vector<int> lanes;
    double length_m = 0.0;
    bool goes_through = false;  // to where vehicles leave the network

    double reach_m() const { return goes_through ? std::numeric_limits<double>::infinity() : length_m; }
};

StraightWay straight_way(const LaneGraph& graph, int first) {
    StraightWay way;
    for (int lane = first; lane >= 0; lane = straight_on(graph, lane)) {
        way.lanes.push_back(lane);
        way.length_m += graph.lanes[at(lane)].length_m;
        way.goes_through = graph.lanes[at(lane)].next.empty();
    }
    return way;
}

// Lanes are numbered from the left: of equals the last one is furthest right. Empty: there is no such street.
StraightWay way_through(const Scenario& scenario, const LaneGraph& graph) {
    const std::string& from = scenario.measure.time_space_from;
    const bool streets = scenario.network.is_streets();
    const std::string inlet =
        streets ? inlet_of_streets(graph, side_of(from)) : inlet_of_grid(scenario.network.grid, from);
    StraightWay best;
    for (const int entry : graph.entries) {
        if (inlet_of(graph.lanes[at(entry)]) != inlet) continue;
        StraightWay way = straight_way(graph, entry);
        if (way.reach_m() >= best.reach_m()) best = std::move(way);
    }
    return best;
}

}  // namespace

StreetWatch::StreetWatch(const Scenario& scenario, const Model& model) : model_(model) {
    if (scenario.measure.time_space_s <= 0.0) return;
    trace_.to_s = scenario.duration_s;
    trace_.from_s = std::max(scenario.duration_s - scenario.measure.time_space_s, 0.0);
    for (const CompiledPolicy& policy : model.policies) trace_.policies.push_back(policy.settings.name);
    const StraightWay way = way_through(scenario, model.graph);
    if (way.lanes.empty()) return;
    trace_.lane = model.graph.lanes[at(way.lanes.front())].name;
    trace_.length_m = way.length_m;
    trace_.goes_through = way.goes_through;
    double from_m = 0.0;
    for (const int lane : way.lanes) {
        pieces_.push_back({lane, from_m, -1});
        from_m += model.graph.lanes[at(lane)].length_m;
    }
}

void StreetWatch::look(const State& state) {
    const double now_s = model_.time_s(state.tick);
    const auto every = std::max<std::int64_t>(to_ticks(kSample_s, model_.step_s), 1);
    if (pieces_.empty() || now_s < trace_.from_s || state.tick % every != 0) return;
    const VehicleArrays& v = state.vehicles;
    for (Piece& piece : pieces_) {
        const LaneBlock& block = state.blocks[at(piece.lane)];
        for (int slot = block.first; slot < block.stop(); ++slot) {
            trace_.points.push_back({now_s, piece.from_m + v.position_m[at(slot)], v.id[at(slot)], v.policy[at(slot)]});
        }
        const Lane& lane = model_.graph.lanes[at(piece.lane)];
        if (lane.signal_group < 0) continue;
        if (model_.signals[at(lane.signal_group)].light(state.tick) != Light::red) {
            piece.light = -1;
            continue;
        }
        if (piece.light < 0) {
            piece.light = static_cast<int>(trace_.reds.size());
            trace_.reds.push_back({piece.from_m + lane.stop_line_m, now_s, now_s});
        }
        trace_.reds[at(piece.light)].to_s = now_s + kSample_s;
    }
}

namespace {

// A line for each vehicle and each stretch that it drives without leaving the street.
std::string lines_of(const StreetTrace& trace, int policy) {
    std::map<int, std::vector<const StreetPoint*>> by_vehicle;
    for (const StreetPoint& point : trace.points) {
        if (point.policy == policy) by_vehicle[point.vehicle].push_back(&point);
    }
    std::string text = "# s, m; vehicles are parted by empty lines\n";
    for (const auto& [vehicle, points] : by_vehicle) {
        double before_s = points.front()->time_s;
        for (const StreetPoint* const point : points) {
            if (point->time_s > before_s + 1.5 * kSample_s) text += "\n";
            text += fmt::format("{:.0f} {:.1f}\n", point->time_s, point->front_m);
            before_s = point->time_s;
        }
        text += "\n";
    }
    return by_vehicle.empty() ? text + "NaN NaN\n" : text;
}

// Why there is nothing to draw; empty: there is.
std::string nothing_in(const std::vector<StreetTrace>& traces, const std::string& from) {
    if (std::any_of(traces.begin(), traces.end(),
                    [](const StreetTrace& trace) { return !trace.points.empty() || !trace.reds.empty(); })) {
        return "";
    }
    if (traces.empty() || !(traces[0].length_m > 0.0)) return "no street leads through the network from the " + from;
    return fmt::format("no vehicle and no red light in the last {:g} s (measure.time_space), looked at every {:g} s",
                       traces[0].to_s - traces[0].from_s, kSample_s);
}

// "Row r2 from west to east, straight on from lane c0r2_west_in_1".
std::string street_title(const Scenario& scenario, const StreetTrace& trace) {
    const Side from = side_of(scenario.measure.time_space_from);
    const auto to = (static_cast<std::size_t>(from) + 2) % kSideNames.size();
    const bool along_row = from == Side::west || from == Side::east;
    const GridSettings& grid = scenario.network.grid;
    std::string street = "Street";
    if (scenario.network.kind == "grid") {
        street = along_row ? fmt::format("Row r{}", grid.rows / 2) : fmt::format("Column c{}", grid.columns / 2);
    }
    std::string title = fmt::format("{} from {} to {}, straight on from lane {}", street,
                                    scenario.measure.time_space_from, kSideNames[to], trace.lane);
    if (!trace.goes_through) {
        title += fmt::format("; no lane goes straight on through all of it: this one ends at {:.0f} m", trace.length_m);
    }
    return title;
}

}  // namespace

Figure time_space_figure(const Scenario& scenario, const std::vector<std::string>& populations,
                         const std::vector<StreetTrace>& traces) {
    Figure figure;
    figure.name = "time_space";
    figure.width_px = 1100;
    figure.height_px = 150 + 330 * static_cast<int>(populations.size());
    figure.nothing = nothing_in(traces, scenario.measure.time_space_from);
    if (traces.empty()) return figure;
    std::string body = fmt::format(
        "set multiplot layout {},1 title {} margins 0.08,0.86,{:.4f},{:.4f} spacing {:.4f}\nset key outside right "
        "top\nset ylabel 'distance from the {} [m]'\n",
        populations.size(), gnuplot_text(street_title(scenario, traces[0])), 70.0 / figure.height_px,
        1.0 - 80.0 / figure.height_px, 80.0 / figure.height_px, scenario.measure.time_space_from);
    for (std::size_t k = 0; k < populations.size(); ++k) {
        const StreetTrace& trace = traces[k];
        std::string reds = "# s, m: when the stop line may not be passed\n";
        for (const RedTime& red : trace.reds) {
            reds += fmt::format("{:.0f} {:.1f}\n{:.0f} {:.1f}\n\n", red.from_s, red.line_m, red.to_s, red.line_m);
        }
        figure.data.emplace_back(fmt::format("time_space_{}_red.dat", k), reds + "NaN NaN\n");
        body += fmt::format("set title {}\nset xrange [{}:{}]\nset yrange [0:{:.0f}]\n{}plot ",
                            gnuplot_text(populations[k]), trace.from_s, trace.to_s, trace.length_m,
                            k + 1 == populations.size() ? "set xlabel 'time [s]'\n" : "set xlabel ' '\n");
        for (std::size_t p = 0; p < trace.policies.size(); ++p) {
            const std::string name = fmt::format("time_space_{}_{}.dat", k, p);
            figure.data.emplace_back(name, lines_of(trace, static_cast<int>(p)));
            body += fmt::format("'{}' with lines lw 0.8 dt 1 lc rgb '{}' title {}, ", name,
                                style_of(scenario, trace.policies[p]).colour, gnuplot_text(trace.policies[p]));
        }
        body += fmt::format("'time_space_{}_red.dat' with lines lw 3 dt 1 lc rgb '#000000' title 'red'\n", k);
    }
    figure.body = body + "unset multiplot\n";
    return figure;
}

std::string time_space_csv(const std::vector<std::string>& populations, const std::vector<StreetTrace>& traces) {
    CsvWriter csv({"population", "time_s", "vehicle", "policy", "front_m"});
    for (std::size_t k = 0; k < populations.size(); ++k) {
        for (const StreetPoint& point : traces[k].points) {
            csv.row({populations[k], fixed(point.time_s, 0), std::to_string(point.vehicle),
                     traces[k].policies[at(point.policy)], fixed(point.front_m, 2)});
        }
    }
    return csv.text();
}

}  // namespace stopline
