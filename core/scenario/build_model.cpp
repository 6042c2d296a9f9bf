#include "scenario/build_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "scenario/build_fleet.h"
#include "scenario/fleets.h"
#include "scenario/import_sumo.h"
#include "scenario/make_network.h"
#include "signals/signal_controller.h"
#include "sim/mesoscale/following_families.h"
#include "sumo_import/sumo_signals.h"

namespace stopline {

namespace {

// Returns true for an approach lane from south or north. In grids and single intersections, these lanes have the odd
// signal group of their intersection.
bool from_south_or_north(const LaneGraph& graph, int lane) { return graph.lanes[at(lane)].signal_group % 2 == 1; }

// Returns the share of the vehicles on the first lane of a route that take this route, 0 .. 1. The share follows from
// the turn shares of the demand.
double share_of(const Scenario& scenario, const Model& model, const Route& route) {
    const LaneGraph& graph = model.graph;
    const std::vector<int>& connections = graph.lanes[at(route.lanes[0])].next;
    const Turn turn_of_route = graph.lanes[at(route.lanes[1])].turn;
    if (connections.size() == 1) return 1.0;
    const auto allows = [&](Turn turn) {
        return std::any_of(connections.begin(), connections.end(),
                           [&](int lane) { return graph.lanes[at(lane)].turn == turn; });
    };
    const bool uses_cross_turns =
        scenario.demand.cross_turns == "separate" && from_south_or_north(graph, route.lanes[0]);
    const double right = uses_cross_turns ? scenario.demand.cross_right_share : scenario.demand.right_share;
    const double left = !allows(Turn::left) ? 0.0
                        : uses_cross_turns  ? scenario.demand.cross_left_share
                                            : scenario.demand.left_share;
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

DemandPlan::Inlet inlet_of(const Scenario& scenario, const Model& model, int lane, const std::vector<int>& routes) {
    DemandPlan::Inlet inlet{lane, 0, routes, {}};
    for (const int route : routes) inlet.shares.push_back(share_of(scenario, model, model.graph.routes[at(route)]));
    return inlet;
}

// Returns true if demand.approaches allows vehicles to enter the network on the lane with the name `lane`.
bool has_demand(const DemandSettings& demand, const std::string& lane) {
    const auto matches = [&](const std::string& approach) { return lane.starts_with(approach + "_"); };
    return demand.approaches.empty() || std::any_of(demand.approaches.begin(), demand.approaches.end(), matches);
}

void add_demand(const Scenario& scenario, Model& model) {
    if (scenario.network.is_sumo()) return add_sumo_trips(scenario, model.demand);
    model.demand.entry_speed_mps = scenario.demand.entry_speed_mps;
    model.demand.seed = scenario.seed;
    model.demand.saturated = scenario.demand.kind == "saturated";
    model.demand.starts_queued = scenario.demand.start == "queued";
    model.demand.route_pattern =
        scenario.demand.order == "random" ? DemandPlan::Pattern::random : DemandPlan::Pattern::balanced;
    const std::int64_t vehicles =
        scenario.demand.kind == "queue" ? scenario.demand.vehicles : std::numeric_limits<std::int64_t>::max();
    const LaneGraph& graph = model.graph;
    if (scenario.network.is_streets()) model.demand.inlets = street_inlets(graph);
    if (scenario.demand.kind == "rate") {
        const IntersectionSettings& layout = scenario.network.intersection;
        const int lanes = scenario.network.has_intersections() ? static_cast<int>(layout.lanes.size())
                                                               : scenario.network.approach.lanes;
        model.demand.entry_headway_s = lanes / scenario.demand.inflow_1ps;
        model.demand.evenly_spaced = true;
    }
    const double cross_headway_s =
        scenario.demand.cross_inflow_1ps > 0.0
            ? static_cast<double>(scenario.network.intersection.lanes.size()) / scenario.demand.cross_inflow_1ps
            : 0.0;
    const std::vector<std::vector<int>> routes = routes_by_first_lane(graph);
    for (std::size_t k = 0; k < graph.entries.size() + graph.links.size(); ++k) {
        const bool entry = k < graph.entries.size();
        const int lane = entry ? graph.entries[k] : graph.links[k - graph.entries.size()];
        const bool used =
            (entry || !scenario.demand.approaches.empty()) && has_demand(scenario.demand, graph.lanes[at(lane)].name);
        if (!scenario.network.is_streets()) {
            model.demand.inlets.push_back(inlet_of(scenario, model, lane, routes[at(lane)]));
        }
        model.demand.inlets[k].vehicles = used ? vehicles : 0;
        if (from_south_or_north(graph, lane)) model.demand.inlets[k].headway_s = cross_headway_s;
    }
}

// Adds a detector on the lane at the boundary of each zone (measure.zones).
void add_zones(const Scenario& scenario, int lane, Model& model) {
    const Lane& road = model.graph.lanes[at(lane)];
    const bool entry = road.signal_group >= 0;
    const std::vector<double>& zones = scenario.measure.zone_radius_m;
    for (std::size_t zone = 0; zone < zones.size(); ++zone) {
        const double from_line_m = zones[zone] - scenario.network.intersection.radius_m;
        model.detectors.push_back({lane, entry ? road.stop_line_m - from_line_m : from_line_m, Detector::Kind::zone,
                                   static_cast<int>(zone), !entry});
    }
}

// Adds detectors to a lane that begins at an intersection, that is, to a lane that is neither an entry lane nor a turn
// pocket: one detector a vehicle length after the start of the lane and, if the lane has a stop line, one in the
// middle.
void add_counters(const Scenario& scenario, int lane, Model& model) {
    const Lane& road = model.graph.lanes[at(lane)];
    const std::vector<int>& entries = model.graph.entries;
    const bool entry = std::find(entries.begin(), entries.end(), lane) != entries.end();
    const bool pocket = road.start_offset_m > 0.0;
    if (entry || pocket) return;
    model.detectors.push_back({lane, scenario.vehicle.length_m, Detector::Kind::exit});
    if (road.signal_group >= 0) model.detectors.push_back({lane, 0.5 * road.stop_line_m, Detector::Kind::middle});
}

void add_connections(Model& model) {
    model.connections_to.resize(model.graph.lanes.size());
    for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
        if (model.graph.lanes[at(lane)].origin < 0) continue;
        model.connections_to[at(model.graph.lanes[at(lane)].next[0])].push_back(lane);
    }
}

void add_rules(const Scenario& scenario, Model& model) {
    const TrafficRules& rules = scenario.rules;
    model.rules.keep_clear = rules.keep_clear == "on";
    model.rules.sight_m = rules.sight_m;
    model.rules.count_queue_at_red_exit = rules.count_queue_at_red_exit == "on";
    const NominalCycle nominal = scenario.nominal_cycle();
    model.rules.teleport_ticks = to_ticks(rules.teleport_cycles * nominal.cycle_s, model.step_s);
    model.rules.pass_blocker_ticks = to_ticks(rules.pass_blocker_greens * nominal.longest_green_s, model.step_s);
    model.rules.gridlock_ticks = to_ticks(nominal.cycle_s, model.step_s);
    model.rules.long_wait_ticks = 2 * model.rules.gridlock_ticks;
    model.rules.starvation_ticks = to_ticks(scenario.measure.starvation_s, model.step_s);
    model.rules.memory_ticks = to_ticks(2.0, model.step_s);
    const bool needs_watch = model.rules.teleport_ticks > 0 || model.rules.pass_blocker_ticks > 0;
    model.rules.watch_ticks = needs_watch ? std::max<std::int64_t>(to_ticks(1.0, model.step_s), 1) : 0;
}

void add_loops(const Scenario& scenario, Model& model) {
    for (const SumoLoopPlace& loop : sumo_loops(scenario)) {
        const int name = static_cast<int>(model.loop_names.size());
        model.detectors.push_back({loop.lane, loop.position_m, Detector::Kind::loop, -1, false, name});
        model.loop_names.push_back(loop.name);
    }
}

// Adds the detectors upstream of a stop line that the controller of the signal asks for.
void add_signal_detectors(int lane, Model& model) {
    const Lane& road = model.graph.lanes[at(lane)];
    const SignalPlan& plan = model.signals.plan_of(road.signal_group);
    if (plan.controller->detectors_m == nullptr) return;
    for (const double to_line_m : plan.controller->detectors_m(plan.settings)) {
        const double position_m = road.stop_line_m - to_line_m;
        if (position_m > 0.0) model.detectors.push_back({lane, position_m, Detector::Kind::signal});
    }
}

void add_detectors(const Scenario& scenario, Model& model) {
    for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
        const Lane& road = model.graph.lanes[at(lane)];
        if (road.signal_group >= 0) {
            model.detectors.push_back({lane, road.stop_line_m, Detector::Kind::stop_line});
            add_signal_detectors(lane, model);
        }
        if (road.origin >= 0) continue;
        if (scenario.network.kind == "intersection") add_zones(scenario, lane, model);
        if (scenario.network.has_several_intersections() && !scenario.network.is_sumo())
            add_counters(scenario, lane, model);
    }
    add_loops(scenario, model);
}

void add_network(const Scenario& scenario, Model& model) {
    const NetworkSettings& network = scenario.network;
    model.graph = make_network(network);
    if (network.is_sumo()) {
        model.signals = make_sumo_signals(*network.sumo, scenario.tick_s());
        model.phase_priorities = make_sumo_phase_priorities(*network.sumo, scenario.tick_s());
    } else if (network.is_streets()) {
        int group = 0;
        for (const StreetIntersection& node : network.streets.intersections) {
            const auto programmes = make_seven_steps(node.programme, node.offset_s, scenario.tick_s());
            model.signals.add(fixed_time_plan(group, {programmes.begin(), programmes.end()}));
            group += static_cast<int>(programmes.size());
        }
    } else if (network.kind == "grid") {
        for (const GridPosition& place : grid_positions(network.grid)) {
            SignalSettings signal = scenario.signal;
            // Whole cycles are removed from the offset, so that the initial red is as short as possible.
            signal.first_green_s +=
                std::fmod((place.column + place.row) * signal.offset_s, signal.intersection_cycle_s());
            model.signals.add(make_signal_plan(signal, model.signals.groups(),
                                               make_stage_programmes(signal, 2, scenario.tick_s()), scenario.tick_s()));
        }
    } else if (network.kind == "intersection") {
        model.signals.add(make_signal_plan(
            scenario.signal, 0, make_stage_programmes(scenario.signal, model.graph.signal_groups, scenario.tick_s()),
            scenario.tick_s()));
    } else {
        model.signals.add(make_signal_plan(scenario.signal, 0, {make_single_light(scenario.signal, scenario.tick_s())},
                                           scenario.tick_s()));
    }
}

}  // namespace

void set_meso(const MesoSettings& settings, Model& model) {
    model.following.clear();
    for (std::size_t k = 0; k < model.policies.size(); ++k) {
        const HumanSettings& human = model.driver_of(static_cast<int>(k)).human;
        model.following.push_back(make_following_model({settings, human}, model.policies[k].meso));
    }
    model.speed_factor = settings.speed_factor;
    model.leader_speed_share = settings.leader_speed_share;
    model.approach_share = std::min(settings.speed_gain_1ps * model.step_s, 1.0);
    model.turn_share = std::min(settings.turn_gain_1ps * model.step_s, 1.0);
    model.leader_mps2 = settings.leader_mps2;
    model.leader_constant_power_speed_mps = settings.leader_constant_power_speed_mps;
    model.leader_profile = leader_profile(settings);
    // Without this factor, a rounding error could make a lane with exactly the calibrated speed limit count as faster.
    constexpr double kRounding = 1.001;
    model.calibrated_limit_mps = kRounding * settings.speed_factor * settings.calibrated_speed_limit_mps;
    model.power_profile = power_profile(model.common_driver());
    model.has_fast_lanes = std::any_of(model.graph.lanes.begin(), model.graph.lanes.end(), [&](const Lane& lane) {
        return model.speed_factor * lane.limit_mps > model.calibrated_limit_mps;
    });
    model.start_relay_vehicles = settings.start_relay_vehicles;
    for (DriverPlan& driver : model.drivers) {
        driver.hesitation_ticks = to_ticks(driver.hesitation_s + settings.start_delay_s, model.step_s);
    }
}

Model build_model(const Scenario& scenario, std::size_t population) {
    Model model;
    model.step_s = scenario.tick_s();
    model.seed = scenario.seed;
    add_network(scenario, model);
    const PopulationSettings& vehicles = scenario.populations.at(population);
    add_fleet(scenario, vehicles, model);
    // radar_delay_s is the time from a measurement until the vehicle responds to it. It includes one step, because the
    // controller uses the data at the start of a step and the vehicle responds from the end of the step on. So the data
    // that the controller uses are older by radar_delay_s minus one step.
    // All drivers of a population have the same delays (check_fleets()).
    const CaccSettings& cacc = driver_of(scenario, vehicles.components.front()).cacc;
    model.radar = make_delay(std::max(cacc.radar_delay_s - scenario.tick_s(), 0.0), scenario.tick_s());
    model.v2v = make_delay(cacc.v2v_delay_s, scenario.tick_s());
    // Human drivers read older measurements. The arrays must keep them for the longest reaction time.
    for (const DriverPlan& driver : model.drivers) {
        if (!driver.is_human) continue;
        const double longest_s = driver.human.reaction_s + driver.human.reaction_spread_s;
        model.radar.rows = std::max(model.radar.rows, make_delay(longest_s, model.step_s).rows);
    }
    if (scenario.is_meso()) {  // mesoscale car following has no radar delay
        model.meso = true;
        model.radar = make_delay(0.0, model.step_s);
        model.v2v = make_delay(model.step_s, model.step_s);
    }
    add_connections(model);
    if (scenario.network.has_intersections()) add_rules(scenario, model);
    add_detectors(scenario, model);
    add_demand(scenario, model);
    assign_trip_policies(scenario, model);
    if (scenario.is_meso()) {
        set_meso(scenario.meso, model);
        add_following_models(scenario, vehicles, model);
    }
    check(model);
    return model;
}

}  // namespace stopline
