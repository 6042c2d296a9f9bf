// Demand and detectors that several kinds of networks share. The turns of vehicles are drawn from shares.
#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

#include "base/containers/index.h"
#include "network/side.h"
#include "scenario/demand/plan_arrivals.h"
#include "scenario/kinds/kind_parts.h"

namespace stopline {

namespace {

bool from_south_or_north(const LaneGraph& graph, int lane) {
    const Side side = comes_from(graph.lanes[at(lane)]);
    return side == Side::south || side == Side::north;
}

// Returns the share of the vehicles on the first lane of a route that take this route, 0 .. 1. The share follows from
// the turn shares of the demand.
double share_of(const DemandSettings& demand, const LaneGraph& graph, const Route& route) {
    const std::vector<int>& connections = graph.lanes[at(route.lanes[0])].next;
    const Turn turn_of_route = graph.lanes[at(route.lanes[1])].turn;
    if (connections.size() == 1) return 1.0;
    const auto allows = [&](Turn turn) {
        return std::any_of(connections.begin(), connections.end(),
                           [&](int lane) { return graph.lanes[at(lane)].turn == turn; });
    };
    const bool uses_cross_turns = demand.cross_turns == "separate" && from_south_or_north(graph, route.lanes[0]);
    const double right = uses_cross_turns ? demand.cross_right_share : demand.right_share;
    const double left = !allows(Turn::left) ? 0.0 : uses_cross_turns ? demand.cross_left_share : demand.left_share;
    // Without a straight connection all vehicles turn, and only the ratio of left to right turns matters.
    const double sum = allows(Turn::straight) ? 1.0 : left + right;
    if (turn_of_route == Turn::left) return left / sum;
    if (turn_of_route == Turn::right) return right / sum;
    return 1.0 - left - (allows(Turn::right) ? right : 0.0);
}

// Returns the indices of the routes that begin on each lane, in ascending order.
std::vector<std::vector<int>> routes_by_first_lane(const LaneGraph& graph) {
    std::vector<std::vector<int>> routes(graph.lanes.size());
    for (std::size_t k = 0; k < graph.routes.size(); ++k) {
        routes[at(graph.routes[k].lanes[0])].push_back(static_cast<int>(k));
    }
    return routes;
}

// Returns the lane of the inlet `k`. The entries come first, then the links.
int inlet_lane(const LaneGraph& graph, std::size_t k) {
    return k < graph.entries.size() ? graph.entries[k] : graph.links[k - graph.entries.size()];
}

// Returns true if demand.approaches allows vehicles to enter the network on the lane with the name `lane`.
bool has_demand(const DemandSettings& demand, const std::string& lane) {
    const auto matches = [&](const std::string& approach) { return lane.starts_with(approach + "_"); };
    return demand.approaches.empty() || std::any_of(demand.approaches.begin(), demand.approaches.end(), matches);
}

}  // namespace

std::vector<DemandPlan::Inlet> inlets_with_turn_shares(const Scenario& scenario, const LaneGraph& graph) {
    const std::vector<std::vector<int>> routes = routes_by_first_lane(graph);
    std::vector<DemandPlan::Inlet> inlets;
    for (std::size_t k = 0; k < graph.entries.size() + graph.links.size(); ++k) {
        const int lane = inlet_lane(graph, k);
        DemandPlan::Inlet inlet{lane, 0, routes[at(lane)], {}};
        for (const int route : inlet.routes) {
            inlet.shares.push_back(share_of(scenario.demand, graph, graph.routes[at(route)]));
        }
        inlets.push_back(std::move(inlet));
    }
    return inlets;
}

void add_drawn_demand(const Scenario& scenario, std::vector<DemandPlan::Inlet> inlets, int lanes, Model& model) {
    const DemandSettings& demand = scenario.demand;
    model.demand.entry_speed_mps = demand.entry_speed_mps;
    model.demand.seed = scenario.seed;
    model.demand.saturated = demand.kind == "saturated";
    model.demand.starts_queued = demand.start == "queued";
    model.demand.route_pattern = demand.order == "random" ? DemandPlan::Pattern::random : DemandPlan::Pattern::balanced;
    const std::int64_t vehicles = demand.kind == "queue" ? demand.vehicles : std::numeric_limits<std::int64_t>::max();
    if (demand.kind == "rate") {
        model.demand.entry_headway_s = lanes / (demand.scale * demand.inflow_1ps);
        model.demand.evenly_spaced = true;
    }
    const double cross_headway_s = demand.cross_inflow_1ps > 0.0 ? lanes / demand.cross_inflow_1ps : 0.0;
    model.demand.inlets = std::move(inlets);
    const LaneGraph& graph = model.graph;
    for (std::size_t k = 0; k < model.demand.inlets.size(); ++k) {
        const int lane = inlet_lane(graph, k);
        const bool is_entry = k < graph.entries.size();
        const bool used = (is_entry || !demand.approaches.empty()) && has_demand(demand, graph.lanes[at(lane)].name);
        model.demand.inlets[k].vehicles = used ? vehicles : 0;
        if (from_south_or_north(graph, lane)) model.demand.inlets[k].headway_s = cross_headway_s;
    }
    if (demand.kind == "od") add_approaches(model.graph);
    if (plans_arrivals(scenario)) plan_arrivals(scenario, model);
}

void add_intersection_demand(const Scenario& scenario, Model& model) {
    add_drawn_demand(scenario, inlets_with_turn_shares(scenario, model.graph),
                     static_cast<int>(scenario.network.intersection.lanes.size()), model);
}

void add_counters(const Scenario& scenario, int lane, Model& model) {
    const Lane& road = model.graph.lanes[at(lane)];
    const std::vector<int>& entries = model.graph.entries;
    const bool entry = std::find(entries.begin(), entries.end(), lane) != entries.end();
    const bool pocket = road.start_offset_m > 0.0;
    if (entry || pocket) return;
    model.detectors.push_back({lane, scenario.vehicle.length_m, Detector::Kind::exit});
    if (road.signal_group >= 0) model.detectors.push_back({lane, 0.5 * road.stop_line_m, Detector::Kind::middle});
}

}  // namespace stopline
