#include "scenario/build_model.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "scenario/build_fleet.h"
#include "scenario/fleets.h"
#include "scenario/import_sumo.h"
#include "scenario/kinds/network_kind.h"
#include "scenario/make_network.h"
#include "signals/signal_controller.h"
#include "sim/mesoscale/following_families.h"
#include "v2v/platoon_length.h"

namespace stopline {

namespace {

void add_connections(Model& model) {
    std::vector<std::vector<int>> connections_to(model.graph.lanes.size());
    for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
        if (model.graph.lanes[at(lane)].origin < 0) continue;
        connections_to[at(model.graph.lanes[at(lane)].next[0])].push_back(lane);
    }
    for (const std::vector<int>& connections : connections_to) model.connections_to.add(connections);
}

void add_rules(const Scenario& scenario, Model& model) {
    const TrafficRules& rules = scenario.rules;
    model.rules.keep_clear = rules.keep_clear == "on";
    model.rules.sight_m = rules.sight_m;
    model.rules.count_queue_at_red_exit = rules.count_queue_at_red_exit == "on";
    model.rules.clearing = model.rules.keep_clear && rules.clearing == "cooperative";
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
    const auto add = [&](int lane, double position_m, const std::string& name) {
        const int index = static_cast<int>(model.loop_names.size());
        model.detectors.push_back({lane, position_m, Detector::Kind::loop, -1, false, index});
        model.loop_names.push_back(name);
    };
    for (const SumoLoopPlace& loop : sumo_loops(scenario)) add(loop.lane, loop.position_m, loop.name);
    const std::vector<Lane>& lanes = model.graph.lanes;
    for (const LoopSettings& loop : scenario.measure.loops) {
        const auto lane =
            std::find_if(lanes.begin(), lanes.end(), [&](const Lane& one) { return one.name == loop.lane; });
        add(static_cast<int>(lane - lanes.begin()), loop_position_m(loop, *lane), loop.name);
    }
}

// Adds the detectors before a stop line that the signal has in its plan or that its controller asks for.
void add_signal_detectors(int lane, Model& model) {
    const Lane& road = model.graph.lanes[at(lane)];
    const SignalPlan& plan = model.signals.plan_of(road.signal_group);
    for (const LaneDetector& detector : plan.lane_detectors) {
        if (detector.lane != lane) continue;
        model.detectors.push_back({lane, road.stop_line_m - detector.to_line_m, Detector::Kind::signal});
        model.detectors.back().length_m = detector.length_m;
    }
    if (plan.controller->detectors_m == nullptr || !plan.lane_detectors.empty()) return;
    for (const double to_line_m : plan.controller->detectors_m(plan.settings)) {
        const double position_m = road.stop_line_m - to_line_m;
        if (position_m > 0.0) model.detectors.push_back({lane, position_m, Detector::Kind::signal});
    }
}

void add_detectors(const NetworkKind& kind, const Scenario& scenario, Model& model) {
    for (int lane = 0; lane < static_cast<int>(model.graph.lanes.size()); ++lane) {
        const Lane& road = model.graph.lanes[at(lane)];
        if (road.signal_group >= 0) {
            model.detectors.push_back({lane, road.stop_line_m, Detector::Kind::stop_line});
            add_signal_detectors(lane, model);
        }
        if (road.origin >= 0) continue;
        if (kind.add_detectors != nullptr) kind.add_detectors(scenario, lane, model);
    }
    add_loops(scenario, model);
}

// Sets the length of platoons and the time gap between them.
void limit_platoons(const DriverSettings& driver, double full_step_s, Model& model) {
    V2vPlan& plan = model.v2v_plan;
    plan.platoon_time_gap_s = driver.platoon.time_gap_s;
    double lag_s = 0.0;
    for (const PowertrainTables& type : model.vehicles) lag_s = std::max(lag_s, type.brake_lag_s);
    const double message_age_s = mean_message_age_s(driver, full_step_s);
    plan.max_platoon = max_platoon_vehicles(driver.platoon, driver.cacc, message_age_s, lag_s);
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
    model.powertrain_delay_s = settings.start_delay_s;
    const double common_mps2 = model.common_driver().deceleration_mps2;
    const auto differs = [&](const DriverPlan& driver) { return driver.tables.deceleration_mps2 != common_mps2; };
    if (std::any_of(model.drivers.begin(), model.drivers.end(), differs)) {
        for (int k = 0; k < static_cast<int>(model.policies.size()); ++k)
            model.slow_downs_mps2.push_back(model.driver_of(k).tables.deceleration_mps2);
    }
    for (DriverPlan& driver : model.drivers) {
        driver.hesitation_ticks = to_ticks(driver.hesitation_s + settings.start_delay_s, model.step_s);
    }
}

Model build_model(const Scenario& scenario, std::size_t population) {
    Model model;
    model.step_s = scenario.tick_s();
    model.seed = scenario.seed;
    const NetworkKind& kind = network_kind(scenario.network);
    model.graph = kind.graph(scenario.network);
    kind.add_signals(scenario, model);
    const PopulationSettings& vehicles = scenario.populations.at(population);
    add_fleet(scenario, vehicles, model);
    // radar_delay_s is the time from a measurement until the vehicle responds to it. It includes one step, because the
    // controller uses the data at the start of a step and the vehicle responds from the end of the step on. So the data
    // that the controller uses are older by radar_delay_s minus one step.
    // All drivers of a population have the same delays (check_fleets()).
    const CaccSettings& cacc = driver_of(scenario, vehicles.components.front()).cacc;
    model.radar = make_delay(std::max(cacc.radar_delay_s - scenario.tick_s(), 0.0), scenario.tick_s());
    model.v2v = make_delay(cacc.v2v_delay_s, scenario.tick_s());
    // Human drivers use measurements that are up to one reaction time old, so the arrays keep them for the longest one.
    for (const DriverPlan& driver : model.drivers) {
        if (!driver.is_human) continue;
        const double longest_s = driver.human.reaction_s + driver.human.reaction_spread_s;
        model.radar.rows = std::max(model.radar.rows, make_delay(longest_s, model.step_s).rows);
    }
    const DriverSettings v2v_driver = v2v_driver_of(scenario, vehicles);
    const V2vSettings& v2v = v2v_driver.v2v;
    const bool active = !scenario.is_meso() && needs_receivers(v2v_driver);
    model.v2v_plan = make_v2v_plan(v2v, active, cacc.v2v_delay_s, model.step_s, model.seed);
    if (active) limit_platoons(v2v_driver, scenario.step_s, model);
    if (scenario.is_meso()) {  // mesoscale car following has no radar delay
        model.meso = true;
        if (is_active_channel(v2v, cacc.radar_range_m)) {
            model.v2v_plan = make_v2v_plan(v2v, true, cacc.v2v_delay_s, model.step_s, model.seed);
            model.v2v_plan.is_active = false;  // vehicles have no receivers, but other functions use the channel
        }
        limit_platoons(v2v_driver, scenario.step_s, model);
        model.radar = make_delay(0.0, model.step_s);
        model.v2v = make_delay(model.step_s, model.step_s);
    }
    add_connections(model);
    if (kind.has_intersections) add_rules(scenario, model);
    add_detectors(kind, scenario, model);
    kind.add_demand(scenario, model);
    assign_trip_policies(scenario, model);
    if (scenario.is_meso()) {
        set_meso(scenario.meso, model);
        if (model.v2v_plan.channel != nullptr) {
            // Each vehicle waits for a message of the vehicle ahead. So the message passes on by one vehicle in a time
            // that is the mean age of messages.
            const double age_s = mean_message_age_s(v2v_driver, 0.0);
            const int receivers = std::max(static_cast<int>(model.step_s / std::max(age_s, 1e-3)), 1);
            model.start_relay_vehicles = std::min(model.start_relay_vehicles, receivers);
        }
        add_following_models(scenario, vehicles, model);
    }
    check(model);
    return model;
}

}  // namespace stopline
