// The kind `intersection`: one intersection with four equal legs.
#include <algorithm>
#include <cstddef>
#include <string>

#include <fmt/format.h>

#include "network/generators/street_checks.h"
#include "network/lane_graph.h"
#include "scenario/kinds/kind_parts.h"
#include "scenario/network_checks.h"
#include "scenario/schema/fields.h"
#include "scenario/turn_checks.h"

namespace stopline {

namespace {

const Table& lane_movements_table() {
    using L = IntersectionSettings::LaneMovements;
    static const Table table = make_table<L>(
        "a lane of an approach",
        {choice<&L::movements>("movements", lane_movements(), "movements that the lane allows, in any order")
             .required()});
    return table;
}

const Table& intersection_table() {
    using S = IntersectionSettings;
    static const Table table = make_table<S>(
        "an intersection with four equal legs at right angles",
        {
            list<&S::lanes>("lanes", lane_movements_table, {1, 6}, "lanes of each approach, from left to right")
                .fallback("[{movements: straight+left}, {movements: straight+right}]"),
            number<&S::radius_m>("radius", "m", {5, 100}, "distance from the centre to the stop line"),
            number<&S::approach_length_m>("approach_length", "m", {50, 20'000},
                                          "distance from the network entry to the stop line"),
            number<&S::exit_length_m>("exit_length", "m", {20, 20'000},
                                      "distance from the intersection to the end of the road"),
            number<&S::lane_width_m>("lane_width", "m", {2, 6}, "width of a lane"),
            number<&S::speed_limit_mps>("speed_limit", "km/h", {5, 150}, "speed limit"),
            number<&S::turn_speed_mps>("turn_speed", "m/s", {1, 40}, "speed on turning connections"),
            number<&S::clearance_m>(
                "clearance", "m", {1, 5},
                "two vehicles touch if their centre lines are nearer than this; at most lane_width - 0.5 m"),
        },
        [](const S& s, Checker& check) {
            const std::string touching = clearance_problem(s.clearance_m, s.lane_width_m);
            if (!touching.empty()) check.error("clearance", touching);
            const double half_m = static_cast<double>(s.lanes.size()) * s.lane_width_m;
            if (half_m + s.clearance_m > s.radius_m) {
                check.error("radius",
                            "the lanes of a leg need at least " + short_text(half_m + s.clearance_m, unit("m")));
            }
        });
    return table;
}

std::vector<Row<NetworkSettings>> intersection_fields() { return {intersection_section()}; }

void add_intersection_signals(const Scenario& scenario, Model& model) {
    if (scenario.signal.has_phases()) return add_phase_signals(scenario, {scenario.signal.first_green_s}, model);
    model.signals.add(make_signal_plan(
        scenario.signal, 0, make_stage_programmes(scenario.signal, model.graph.signal_groups, scenario.tick_s()),
        scenario.tick_s()));
}

// Adds a detector on the lane at the boundary of each zone (measure.zones).
void add_zones(const Scenario& scenario, int lane, Model& model) {
    const Lane& road = model.graph.lanes[static_cast<std::size_t>(lane)];
    const bool entry = road.signal_group >= 0;
    const std::vector<double>& zones = scenario.measure.zone_radius_m;
    for (std::size_t zone = 0; zone < zones.size(); ++zone) {
        const double from_line_m = zones[zone] - scenario.network.intersection.radius_m;
        model.detectors.push_back({lane, entry ? road.stop_line_m - from_line_m : from_line_m, Detector::Kind::zone,
                                   static_cast<int>(zone), !entry});
    }
}

void check_duration(const Scenario& scenario, Checker& check) {
    const double cycle_s = scenario.nominal_cycle().cycle_s;
    const double shortest_s = scenario.signal.first_green_s + (scenario.measure.warmup_cycles + 1) * cycle_s;
    if (scenario.duration_s != 0.0 && scenario.duration_s < shortest_s) {
        check.error("duration",
                    "leaves no whole cycle to measure after first_green and warmup_cycles: must be at least " +
                        short_text(shortest_s, unit("s")));
    } else if (scenario.duration_s != 0.0 && check.given("measure.cycles") &&
               scenario.measure.cycles != cycles_within_duration(scenario)) {
        check.error(
            "measure.cycles",
            fmt::format("{} cycles contradict the duration of {}, in which {} whole cycles can be measured: give "
                        "only one of the two fields, or 'duration: 0 s' for the time that the cycles take",
                        scenario.measure.cycles, short_text(scenario.duration_s, unit("s")),
                        cycles_within_duration(scenario)));
    }
}

void check_zones(const Scenario& scenario, Checker& check) {
    const IntersectionSettings& layout = scenario.network.intersection;
    const double reach_m = layout.radius_m + std::min(layout.approach_length_m, layout.exit_length_m);
    for (std::size_t i = 0; i < scenario.measure.zone_radius_m.size(); ++i) {
        const double radius_m = scenario.measure.zone_radius_m[i];
        if (radius_m > layout.radius_m && radius_m < reach_m) continue;
        check.error("measure.zones[" + std::to_string(i) + "]",
                    "must lie between the radius of the intersection and the end of its legs, " +
                        short_text(layout.radius_m, unit("m")) + " to " + short_text(reach_m, unit("m")));
    }
}

void check_intersection(const Scenario& scenario, Checker& check) {
    check_turn_shares(scenario, check);
    refuse_cycle(scenario, check);
    refuse_offset(scenario, check);
    check_signal_steps(scenario, check);
    check_phases(scenario, check);
    check_duration(scenario, check);
    check_zones(scenario, check);
}

}  // namespace

Row<NetworkSettings> intersection_section() {
    return section<&NetworkSettings::intersection>("intersection", intersection_table,
                                                   "layout of an intersection, single or in a grid");
}

std::vector<OuterLeg> intersection_legs(const NetworkSettings& network) {
    const IntersectionSettings& layout = network.intersection;
    return {{"network.intersection.approach_length", "network.intersection.exit_length", layout.speed_limit_mps,
             layout.approach_length_m, layout.exit_length_m}};
}

double intersection_limit_mps(const NetworkSettings& network) { return network.intersection.speed_limit_mps; }

double intersection_lane_width_m(const NetworkSettings& network) { return network.intersection.lane_width_m; }

double intersection_radius_m(const NetworkSettings& network, const Lane& /*lane*/) {
    return network.intersection.radius_m;
}

extern const NetworkKind kIntersectionKind{
    .name = "intersection",
    .meaning = "one intersection with four equal legs",
    .run = kRunAsIntersection,
    .signal_groups = 2,
    .ends_after_cycles = true,
    .fields = intersection_fields,
    .graph = [](const NetworkSettings& network) { return make_intersection(network.intersection); },
    .add_signals = add_intersection_signals,
    .add_demand = add_intersection_demand,
    .outer_legs = intersection_legs,
    .highest_limit_mps = intersection_limit_mps,
    .lane_width_m = intersection_lane_width_m,
    .check = check_intersection,
    .radius_beyond_m = intersection_radius_m,
    .add_detectors = add_zones};

}  // namespace stopline
