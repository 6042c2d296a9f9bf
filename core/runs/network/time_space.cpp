#include "runs/network/time_space.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/io/csv.h"
#include "measure/area.h"
#include "scenario/kinds/network_kind.h"

namespace stopline {

namespace {

// Returns the next lane for vehicles that go straight on; -1 if there is none.
int straight_on(const LaneGraph& graph, int lane) {
    for (const int next : graph.lanes[at(lane)].next) {
        const Turn turn = graph.lanes[at(next)].turn;
        if (turn == Turn::straight || turn == Turn::none) return next;
    }
    return -1;
}

// Returns the name of an approach lane without its number, such as "c0r2_west_in_".
std::string approach_prefix(const Lane& lane) { return lane.name.substr(0, lane.name.find_last_of('_') + 1); }

// An entry lane and the lanes that follow for a vehicle that always goes straight on.
struct StraightPath {
    std::vector<int> lanes;
    double length_m = 0.0;
    bool reaches_exit = false;  // true: the last lane leaves the network

    double reach_m() const { return reaches_exit ? std::numeric_limits<double>::infinity() : length_m; }
};

StraightPath straight_path_from(const LaneGraph& graph, int first) {
    StraightPath path;
    for (int lane = first; lane >= 0; lane = straight_on(graph, lane)) {
        path.lanes.push_back(lane);
        path.length_m += graph.lanes[at(lane)].length_m;
        path.reaches_exit = graph.lanes[at(lane)].next.empty();
    }
    return path;
}

// Returns the longest straight path from the side measure.time_space_side (in a grid, along the middle row or column).
// Returns an empty path if no street begins there. A path to an exit counts as longer than any other path. Of equally
// long paths, the rightmost one is taken: it comes last, because lanes are numbered from the left.
StraightPath find_path(const Scenario& scenario, const LaneGraph& graph) {
    const NetworkKind& kind = network_kind(scenario.network);
    StraightPath best;
    if (kind.diagram_street == nullptr) return best;
    const std::string prefix =
        kind.diagram_street(scenario.network, graph, side_named(scenario.measure.time_space_side)).lane_prefix;
    for (const int entry : graph.entries) {
        if (approach_prefix(graph.lanes[at(entry)]) != prefix) continue;
        StraightPath path = straight_path_from(graph, entry);
        if (path.reach_m() >= best.reach_m()) best = std::move(path);
    }
    return best;
}

}  // namespace

StreetTracer::StreetTracer(const Scenario& scenario, const Model& model) : model_(model) {
    if (scenario.measure.time_space_s <= 0.0) return;
    trace_.to_s = scenario.duration_s;
    trace_.from_s = std::max(scenario.duration_s - scenario.measure.time_space_s, 0.0);
    for (const GapPolicy& policy : model.policies) trace_.policies.push_back(policy.settings.name);
    const StraightPath path = find_path(scenario, model.graph);
    if (path.lanes.empty()) return;
    trace_.first_lane = model.graph.lanes[at(path.lanes.front())].name;
    trace_.length_m = path.length_m;
    trace_.reaches_exit = path.reaches_exit;
    double from_m = 0.0;
    for (const int lane : path.lanes) {
        pieces_.push_back({lane, from_m, -1});
        from_m += model.graph.lanes[at(lane)].length_m;
    }
}

void StreetTracer::sample(const State& state) {
    const double now_s = model_.time_s(state.tick);
    const auto sample_ticks = std::max<std::int64_t>(to_ticks(kTimeSpaceSample_s, model_.step_s), 1);
    if (pieces_.empty() || now_s < trace_.from_s || state.tick % sample_ticks != 0) return;
    const VehicleArrays& v = state.vehicles;
    for (Piece& piece : pieces_) {
        const LaneBlock& block = state.blocks[at(piece.lane)];
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            trace_.points.push_back({now_s, piece.from_m + v.position_m[at(slot)], v.id[at(slot)], v.policy[at(slot)]});
        }
        const Lane& lane = model_.graph.lanes[at(piece.lane)];
        if (lane.signal_group < 0) continue;
        if (state.signals.lights[at(lane.signal_group)] != Light::red) {
            piece.red = -1;
            continue;
        }
        if (piece.red < 0) {
            piece.red = static_cast<int>(trace_.reds.size());
            trace_.reds.push_back({piece.from_m + lane.stop_line_m, now_s, now_s});
        }
        trace_.reds[at(piece.red)].to_s = now_s + kTimeSpaceSample_s;
    }
}

std::string time_space_csv(const std::vector<std::string>& populations, const std::vector<StreetTrace>& traces) {
    CsvWriter csv({"population", "time_s", "vehicle", "policy", "position_m"});
    for (std::size_t k = 0; k < populations.size(); ++k) {
        for (const StreetPoint& point : traces[k].points) {
            csv.row({populations[k], fixed(point.time_s, 0), std::to_string(point.vehicle),
                     traces[k].policies[at(point.policy)], fixed(point.position_m, 2)});
        }
    }
    return csv.text();
}

}  // namespace stopline
