#include "experiment/time_space.h"

#include <algorithm>
#include <cstddef>
#include <map>

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

// Of streets: the lane next to the kerb on which vehicles enter the network furthest in the west, heading east. Of a grid: the lane from
// the west in the middle row that goes straight on next to the kerb. -1: there is none.
int first_lane(const Scenario& scenario, const LaneGraph& graph) {
    const auto row = scenario.network.grid.rows / 2;
    const auto right = static_cast<int>(scenario.network.intersection.lanes.size()) - 1;
    const std::string name = fmt::format("west_in_{}", right);
    const std::string in_grid = fmt::format("c0r{}_{}", row, name);
    int first = -1;
    for (const int entry : graph.entries) {
        const Lane& lane = graph.lanes[at(entry)];
        if (lane.name == in_grid || lane.name == name) return entry;
        if (!scenario.network.is_streets() || comes_from(lane) != Side::west || straight_on(graph, entry) < 0) continue;
        if (first < 0 || lane.shape[0].x_m <= graph.lanes[at(first)].shape[0].x_m) first = entry;
    }
    return first;
}

}  // namespace

StreetWatch::StreetWatch(const Scenario& scenario, const Model& model) : model_(model) {
    if (scenario.measure.time_space_s <= 0.0) return;
    trace_.to_s = scenario.duration_s;
    trace_.from_s = std::max(scenario.duration_s - scenario.measure.time_space_s, 0.0);
    for (const CompiledPolicy& policy : model.policies) trace_.policies.push_back(policy.settings.name);
    double from_m = 0.0;
    for (int lane = first_lane(scenario, model.graph); lane >= 0; lane = straight_on(model.graph, lane)) {
        pieces_.push_back({lane, from_m, -1});
        from_m += model.graph.lanes[at(lane)].length_m;
    }
    trace_.length_m = from_m;
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
std::string nothing_in(const std::vector<StreetTrace>& traces) {
    if (std::any_of(traces.begin(), traces.end(),
                    [](const StreetTrace& trace) { return !trace.points.empty() || !trace.reds.empty(); })) {
        return "";
    }
    if (traces.empty() || !(traces[0].length_m > 0.0)) return "no street leads through the network from the west";
    return fmt::format("no vehicle and no red light in the last {:g} s (measure.time_space), looked at every {:g} s",
                       traces[0].to_s - traces[0].from_s, kSample_s);
}

}  // namespace

Figure time_space_figure(const Scenario& scenario, const std::vector<std::string>& populations,
                         const std::vector<StreetTrace>& traces) {
    Figure figure;
    figure.name = "time_space";
    figure.width_px = 1100;
    figure.height_px = 120 + 330 * static_cast<int>(populations.size());
    figure.nothing = nothing_in(traces);
    std::string body = fmt::format(
        "set multiplot layout {},1 margins 0.08,0.86,{:.4f},{:.4f} spacing {:.4f}\nset key outside right top\nset ylabel "
        "'distance [m]'\n",
        populations.size(), 70.0 / figure.height_px, 1.0 - 50.0 / figure.height_px, 80.0 / figure.height_px);
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
