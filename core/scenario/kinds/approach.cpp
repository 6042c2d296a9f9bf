// The kind `approach`: a straight road with one stop line.
#include "network/lane_graph.h"
#include "scenario/kinds/kind_parts.h"
#include "scenario/network_checks.h"
#include "scenario/turn_checks.h"

namespace stopline {

namespace {

const Table& approach_table() {
    static const Table table = make_table<ApproachSettings>(
        "a straight road with one stop line",
        {
            whole_number<&ApproachSettings::lanes>("lanes", {1, 16}, "number of parallel lanes"),
            number<&ApproachSettings::length_m>("length", "m", {10, 20'000},
                                                "distance from the entry to the stop line"),
            number<&ApproachSettings::exit_length_m>("exit_length", "m", {10, 20'000},
                                                     "distance from the stop line to the end of the road"),
            number<&ApproachSettings::speed_limit_mps>("speed_limit", "km/h", {5, 150}, "speed limit"),
            number<&ApproachSettings::gradient>("gradient", "%", {-20, 20},
                                                "slope, positive uphill; only with fidelity: full"),
        });
    return table;
}

std::vector<Row<NetworkSettings>> approach_fields() {
    return {section<&NetworkSettings::approach>("approach", approach_table, "straight road with one stop line")};
}

void add_approach_signals(const Scenario& scenario, Model& model) {
    model.signals.add(make_signal_plan(scenario.signal, 0, {make_single_light(scenario.signal, scenario.tick_s())},
                                       scenario.tick_s()));
}

void add_approach_demand(const Scenario& scenario, Model& model) {
    add_drawn_demand(scenario, inlets_with_turn_shares(scenario, model.graph), scenario.network.approach.lanes, model);
}

std::vector<OuterLeg> approach_legs(const NetworkSettings& network) {
    const ApproachSettings& road = network.approach;
    return {{"network.approach.length", "network.approach.exit_length", road.speed_limit_mps, road.length_m,
             road.exit_length_m}};
}

// Reports fields of the section `signal` that have no effect on a single light.
void refuse_signal_times(const Scenario& scenario, Checker& check) {
    refuse_offset(scenario, check);
    if (scenario.signal.cross_green_s != 0.0) {
        check.error("signal.cross_green",
                    "is for intersections and grids only: a straight road has no crossing street");
    }
    if (scenario.signal.clock_s != 0.0) {
        check.error("signal.clock", "acts only with signal.programmes, which a straight road does not have");
    }
}

// Only full dynamics has slopes. The mesoscale mode would drive uphill as on a level road.
void refuse_gradient_in_meso(const Scenario& scenario, Checker& check) {
    if (!scenario.is_meso() || scenario.network.approach.gradient == 0.0) return;
    check.error("network.approach.gradient", "has no effect in the mesoscale mode; use fidelity: full, or set 0 %");
}

void check_approach(const Scenario& scenario, Checker& check) {
    refuse_gradient_in_meso(scenario, check);
    refuse_cross_inflow(scenario, check);
    refuse_turns(scenario.demand, "a straight road", check);
    refuse_phases(scenario, "a straight road", check);
    check_signal_steps(scenario, check);
    refuse_signal_times(scenario, check);
    check_green_times(scenario, check);
    check_first_green(scenario, check);
    check_queue(scenario, check);
}

}  // namespace

extern const NetworkKind kApproachKind{
    .name = "approach",
    .meaning = "a straight road with one stop line",
    .run = kRunAsSingleLight,
    .signal_groups = 1,
    .has_intersections = false,
    .fields = approach_fields,
    .graph = [](const NetworkSettings& network) { return make_approach(network.approach); },
    .add_signals = add_approach_signals,
    .add_demand = add_approach_demand,
    .outer_legs = approach_legs,
    .highest_limit_mps = [](const NetworkSettings& network) { return network.approach.speed_limit_mps; },
    .lane_width_m = [](const NetworkSettings& /*network*/) { return 3.5; },
    .check = check_approach};

}  // namespace stopline
