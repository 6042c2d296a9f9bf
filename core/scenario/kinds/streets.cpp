// The kind `streets`: signalised intersections that streets join, such as those of data/berlin.
#include <algorithm>
#include <cstddef>
#include <string>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "network/generators/street_layout.h"
#include "network/lane_graph.h"
#include "scenario/demand/plan_arrivals.h"
#include "scenario/kinds/kind_parts.h"
#include "scenario/network_checks.h"
#include "scenario/schema/fields.h"
#include "scenario/turn_checks.h"
#include "signals/street_phases.h"

namespace stopline {

namespace {

std::vector<Row<NetworkSettings>> street_fields() {
    return {
        section<&NetworkSettings::streets>("streets", streets_table, "streets with signalised intersections", "berlin")
            .required()};
}

void add_street_signals(const Scenario& scenario, Model& model) {
    const bool is_fixed = find_signal_controller(scenario.signal.controller).follows_programme;
    for (const StreetIntersection& node : scenario.network.streets.intersections) {
        if (!is_fixed) {
            model.signals.add(
                make_street_signal_plan(scenario.signal, node, model.signals.groups(), scenario.tick_s()));
            continue;
        }
        const auto programmes = make_seven_steps(node.programme, node.offset_s, scenario.tick_s());
        model.signals.add(fixed_time_plan(model.signals.groups(), {programmes.begin(), programmes.end()}));
    }
}

void add_street_demand(const Scenario& scenario, Model& model) {
    // The field demand.inflow is not allowed, so the number of lanes has no effect.
    add_drawn_demand(scenario, street_inlets(model.graph), 1, model);
}

std::vector<OuterLeg> street_legs(const NetworkSettings& network) {
    const StreetLayout layout(network.streets);
    std::vector<OuterLeg> legs;
    for (int n = 0; n < layout.nodes(); ++n) {
        const StreetIntersection& node = layout.node(n);
        for (std::size_t k = 0; k < node.legs.size(); ++k) {
            const StreetLeg& leg = node.legs[k];
            const auto* const side = std::find(kSides.begin(), kSides.end(), leg.from);
            if (layout.neighbour(n, static_cast<int>(side - kSides.begin())) >= 0) continue;
            const std::string field = fmt::format("network.streets.intersections[{}].legs[{}]", node.name, k);
            legs.push_back({field + ".length", field + ".exit_length", leg.speed_limit_mps,
                            leg.lanes.empty() ? 0.0 : leg.length_m, leg.exits == 0 ? 0.0 : leg.exit_length_m});
        }
    }
    return legs;
}

double street_limit_mps(const NetworkSettings& network) {
    double highest_mps = 0.0;
    for (const StreetIntersection& node : network.streets.intersections) {
        for (const StreetLeg& leg : node.legs) highest_mps = std::max(highest_mps, leg.speed_limit_mps);
    }
    return highest_mps;
}

// Reports fields of the section `signal` that have no effect beside the programmes of streets.
void refuse_signal_times(const SignalSettings& signal, Checker& check) {
    const SignalSettings defaults;
    const auto refuse = [&](const char* name, double value_s, double default_s) {
        if (value_s == default_s) return;
        check.error(std::string("signal.") + name,
                    "has no effect on streets: the programmes of network.streets have times of their own");
    };
    refuse("first_green", signal.first_green_s, defaults.first_green_s);
    refuse("green", signal.green_s, defaults.green_s);
    refuse("cross_green", signal.cross_green_s, defaults.cross_green_s);
    refuse("yellow", signal.yellow_s, defaults.yellow_s);
    refuse("all_red", signal.all_red_s, defaults.all_red_s);
    refuse("offset", signal.offset_s, defaults.offset_s);
    refuse("cycle", signal.cycle_s, defaults.cycle_s);
    refuse("clock", signal.clock_s, defaults.clock_s);
}

void check_street_signals(const Scenario& scenario, Checker& check) {
    const SignalSettings& signal = scenario.signal;
    refuse_signal_times(signal, check);
    refuse_phases(scenario, "streets, whose phases follow from the programmes of network.streets", check);
    if (signal.controller == "fixed_time" || signal.controller == "actuated") return;
    check.error(
        "signal.controller",
        fmt::format("'{}' cannot run the programmes of streets (allowed: fixed_time, actuated)", signal.controller));
}

void check_streets(const Scenario& scenario, Checker& check) {
    refuse_cross_inflow(scenario, check);
    refuse_turns(scenario.demand, "streets, which have turn shares for each leg", check);
    for (const StreetIntersection& node : scenario.network.streets.intersections) {
        const std::string field = "network.streets.intersections[" + node.name + "]";
        for (const double step_s : node.programme.steps_s()) {
            check_whole_steps(scenario, field + ".programme", step_s, check);
        }
        check_whole_steps(scenario, field + ".offset", node.offset_s, check);
    }
    if (scenario.demand.kind == "rate" && !plans_arrivals(scenario)) {
        check.error("demand.kind",
                    "in streets, value 'rate' needs a demand.profile, or demand.arrivals: poisson or platooned");
    }
    check_street_signals(scenario, check);
    check_street_links(scenario, check);
    check_pockets(scenario, check);
}

double street_radius_m(const NetworkSettings& network, const Lane& lane) {
    constexpr int kGroupsPerIntersection = 3;  // signal groups of one intersection of streets, see make_streets()
    return network.streets.intersections[at(lane.signal_group / kGroupsPerIntersection)].radius_m;
}

NominalCycle street_cycle(const Scenario& scenario) {
    const StreetSettings& streets = scenario.network.streets;
    NominalCycle nominal{streets.intersections.front().programme.cycle_s(), streets.longest_green_s()};
    if (find_signal_controller(scenario.signal.controller).follows_programme) return nominal;
    for (const StreetIntersection& node : streets.intersections) {
        const ProgrammeSettings phases{0.0, make_street_phases(node)};
        nominal.cycle_s = std::max(nominal.cycle_s, phases.cycle_s());
    }
    return nominal;
}

// Returns the coordinate of the start of a lane, m. The axis points from the origin toward `side`.
double outwards_m(const Lane& lane, Side side) {
    const auto& begin = lane.shape[0];
    if (side == Side::west) return -begin.x_m;
    if (side == Side::east) return begin.x_m;
    return side == Side::south ? -begin.y_m : begin.y_m;
}

bool has_straight_connection(const LaneGraph& graph, int lane) {
    const std::vector<int>& next = graph.lanes[at(lane)].next;
    return std::any_of(next.begin(), next.end(), [&](int connection) {
        const Turn turn = graph.lanes[at(connection)].turn;
        return turn == Turn::straight || turn == Turn::none;
    });
}

// Returns the approach with the entry lanes that begin furthest out on `side` of the network. Entry lanes without a
// straight connection do not count.
DiagramStreet outermost_street(const NetworkSettings& /*network*/, const LaneGraph& graph, Side side) {
    const Lane* furthest = nullptr;
    for (const int entry : graph.entries) {
        const Lane& lane = graph.lanes[at(entry)];
        if (comes_from(lane) != side || !has_straight_connection(graph, entry)) continue;
        if (furthest == nullptr || outwards_m(lane, side) >= outwards_m(*furthest, side)) furthest = &lane;
    }
    if (furthest == nullptr) return {"", "Street"};
    return {furthest->name.substr(0, furthest->name.find_last_of('_') + 1), "Street"};
}

}  // namespace

extern const NetworkKind kStreetsKind{
    .name = "streets",
    .meaning = "signalised intersections joined by streets, from a file",
    .run = kRunAsNetwork,
    .chooses_controller = true,
    .has_measured_area = true,
    .reports_approaches = true,
    .fields = street_fields,
    .graph = [](const NetworkSettings& network) { return make_streets(network.streets); },
    .add_signals = add_street_signals,
    .add_demand = add_street_demand,
    .outer_legs = street_legs,
    .highest_limit_mps = street_limit_mps,
    .lane_width_m = [](const NetworkSettings& network) { return network.streets.lane_width_m; },
    .check = check_streets,
    .radius_beyond_m = street_radius_m,
    .nominal_cycle = street_cycle,
    .add_detectors = add_counters,
    .diagram_street = outermost_street};

}  // namespace stopline
