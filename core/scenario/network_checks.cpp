#include "scenario/network_checks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "base/nearest_name.h"
#include "base/simd/arithmetic.h"
#include "network/generators/street_layout.h"
#include "scenario/approach_names.h"
#include "scenario/fleets.h"
#include "scenario/kinds/network_kind.h"
#include "scenario/make_network.h"
#include "scenario/schema/quantity.h"
#include "signals/actuation.h"

namespace stopline {
namespace {

constexpr double kRounding_m = 1e-9;

std::string metres(double value) { return short_text(value, unit("m")); }

// Returns the longest standstill gap of the policies that the populations use, m.
double longest_standstill_gap_m(const Scenario& scenario) {
    double longest_m = 0.0;
    for (const PopulationSettings::Component* component : all_components(scenario)) {
        for (const GapPolicySettings& policy : scenario.policies) {
            if (component->policy == policy.name) longest_m = std::max(longest_m, policy.standstill_gap_m);
        }
    }
    return longest_m;
}

// Returns the length that the longest vehicle needs in a queue, m: vehicle length and standstill gap.
double queue_space_m(const Scenario& scenario) {
    return longest_vehicle_m(scenario) + longest_standstill_gap_m(scenario);
}

// Returns the longest stopping distance of all vehicles with the deceleration that their drivers accept on yellow, m.
// The result includes the distance driven during the lag of the brake and while the deceleration builds up
// (sim/junction/stop_lines.cpp). It is rounded up to 0.1 m, so that a user can enter the minimum that a message names.
double stopping_m(const Scenario& scenario, double speed_mps) {
    double longest_m = 0.0;
    for (const PopulationSettings::Component* component : all_components(scenario)) {
        const DriverSettings& driver = driver_of(scenario, *component);
        const double b = driver.stop.decision_deceleration_mps2;
        const double brake_lag_s = vehicle_of(scenario, *component).brake_lag_s;
        const double delay_s = brake_lag_s + 0.5 * b / driver.cacc.jerk_down_mps3;
        longest_m = std::max(longest_m, speed_mps * delay_s + square(speed_mps) / (2.0 * b));
    }
    return std::ceil(10.0 * longest_m) / 10.0;
}

// Explains stopping_m() in messages.
std::string stopping_text(const Scenario& scenario, double speed_mps) {
    double lowest_mps2 = std::numeric_limits<double>::infinity();
    for (const PopulationSettings::Component* component : all_components(scenario)) {
        lowest_mps2 = std::min(lowest_mps2, driver_of(scenario, *component).stop.decision_deceleration_mps2);
    }
    return "to stop from " + short_text(speed_mps, unit("km/h")) + " at " + short_text(lowest_mps2, unit("m/s2")) +
           " (driver.stop.decision_deceleration)";
}

// Returns the shortest road between two intersections on which a vehicle has room and can stop, m.
double min_link_m(const Scenario& scenario, double speed_mps) {
    return std::max(queue_space_m(scenario), stopping_m(scenario, speed_mps));
}

// Explains min_link_m() in messages.
std::string link_needs_text(const Scenario& scenario, double speed_mps) {
    return "as a vehicle with its gap needs " + metres(queue_space_m(scenario)) + ", and " +
           metres(stopping_m(scenario, speed_mps)) + " " + stopping_text(scenario, speed_mps);
}

// Returns the longest distance of all drivers between a vehicle at rest and the stop line, m.
double longest_stop_margin_m(const Scenario& scenario) {
    double longest_m = 0.0;
    for (const PopulationSettings::Component* component : all_components(scenario)) {
        longest_m = std::max(longest_m, driver_of(scenario, *component).stop.margin_m);
    }
    return longest_m;
}

}  // namespace

void check_queue(const Scenario& scenario, Checker& check) {
    if (scenario.demand.kind != "queue") return;
    double mean_length_m = 0.0;
    for (const PopulationSettings& population : scenario.populations) {
        mean_length_m = std::max(mean_length_m, mean_vehicle_m(scenario, population));
    }
    const double space_m = mean_length_m + longest_standstill_gap_m(scenario);
    const double queue_m = scenario.demand.vehicles * space_m + longest_stop_margin_m(scenario);
    if (scenario.network.approach.length_m >= queue_m) return;
    check.error("network.approach.length",
                "a queue of " + std::to_string(scenario.demand.vehicles) + " vehicles a lane is " + metres(queue_m) +
                    " long, longer than the approach of " + metres(scenario.network.approach.length_m));
}

void check_grid_links(const Scenario& scenario, Checker& check) {
    const GridSettings& grid = scenario.network.grid;
    const IntersectionSettings& layout = scenario.network.intersection;
    const double min_length_m = min_link_m(scenario, layout.speed_limit_mps);
    const auto check_spacing = [&](const std::string& field, double spacing_m) {
        const double min_spacing_m = 2.0 * layout.radius_m + min_length_m;
        if (spacing_m >= min_spacing_m - kRounding_m) return;
        check.error("network.grid." + field,
                    "value " + metres(spacing_m) + " leaves " + metres(spacing_m - 2.0 * layout.radius_m) +
                        " of road between intersections of network.intersection.radius = " + metres(layout.radius_m) +
                        ": at least " + metres(min_spacing_m) + " with this radius, " +
                        link_needs_text(scenario, layout.speed_limit_mps));
    };
    if (grid.columns > 1) check_spacing("column_spacing", grid.column_spacing_m);
    if (grid.rows > 1) check_spacing("row_spacing", grid.row_spacing_m);
}

void check_street_links(const Scenario& scenario, Checker& check) {
    const StreetLayout layout(scenario.network.streets);
    for (int n = 0; n < layout.nodes(); ++n) {
        for (int side = 0; side < static_cast<int>(kSides.size()); ++side) {
            const StreetLeg* const leg = layout.leg(n, side);
            const int other = layout.neighbour(n, side);
            if (leg == nullptr || leg->lanes.empty() || other < 0) continue;
            const double length_m = layout.length_m(n, side);
            const double min_length_m = min_link_m(scenario, leg->speed_limit_mps);
            if (length_m >= min_length_m - kRounding_m) continue;
            check.error("network.streets.intersections[" + layout.node(n).name + "].x",
                        "leaves " + metres(length_m) + " of road from '" + layout.node(other).name +
                            "' to the stop line: at least " + metres(min_length_m) + ", " +
                            link_needs_text(scenario, leg->speed_limit_mps) + "; or give this leg a lower speed_limit");
        }
    }
}

void check_pockets(const Scenario& scenario, Checker& check) {
    for (const StreetIntersection& node : scenario.network.streets.intersections) {
        for (std::size_t a = 0; a < node.legs.size(); ++a) {
            for (std::size_t k = 0; k < node.legs[a].lanes.size(); ++k) {
                const double pocket_m = node.legs[a].lanes[k].pocket_m;
                if (pocket_m == 0.0 || pocket_m >= queue_space_m(scenario) - kRounding_m) continue;
                check.error("network.streets.intersections[" + node.name + "].legs[" + std::to_string(a) + "].lanes[" +
                                std::to_string(k) + "].pocket",
                            "value " + metres(pocket_m) + " is too short for a vehicle of " +
                                metres(longest_vehicle_m(scenario)) + " and its standstill gap: at least " +
                                metres(queue_space_m(scenario)) + ", or 0 m for a lane as long as the approach");
            }
        }
    }
}

void check_entries(const Scenario& scenario, Checker& check) {
    for (const OuterLeg& leg : network_kind(scenario.network).outer_legs(scenario.network)) {
        const double speed_mps = std::min(scenario.demand.entry_speed_mps, leg.limit_mps);
        const double min_length_m = stopping_m(scenario, speed_mps);
        if (leg.length_m == 0.0 || leg.length_m >= min_length_m) continue;
        check.error(leg.length_field, "value " + metres(leg.length_m) + " is too short " +
                                          stopping_text(scenario, speed_mps) + " before the stop line: at least " +
                                          metres(min_length_m) + ", or a lower demand.entry_speed than " +
                                          short_text(scenario.demand.entry_speed_mps, unit("km/h")));
    }
}

// A vehicle at rest occupies the road from driver.stop.margin before the stop line to a vehicle length further
// upstream. The detector must lie in this part of the road for all vehicles.
void check_stop_detector(const Scenario& scenario, Checker& check) {
    const NetworkKind& kind = network_kind(scenario.network);
    const SignalController& controller = find_signal_controller(scenario.signal.controller);
    const auto is_stop_detector = [](const SignalParameter& one) {
        return std::string_view(one.name) == kStopDetectorParameter.name;
    };
    const bool has_detector = std::any_of(controller.parameters.begin(), controller.parameters.end(), is_stop_detector);
    if (!has_detector || (kind.signal_groups == 0 && !kind.chooses_controller)) return;
    const double detector_m = signal_parameter(scenario.signal, kStopDetectorParameter.name);
    for (const PopulationSettings::Component* component : all_components(scenario)) {
        const double front_m = driver_of(scenario, *component).stop.margin_m;
        const double length_m = vehicle_of(scenario, *component).length_m;
        if (detector_m >= front_m - kRounding_m && detector_m <= front_m + length_m + kRounding_m) continue;
        return check.error("signal.stop_detector",
                           "value " + metres(detector_m) +
                               ": a vehicle that waits at the stop line is not on the detector and gets no " +
                               "green. For a vehicle of " + metres(length_m) + " with driver.stop.margin = " +
                               metres(front_m) + ", give " + metres(front_m) + " to " + metres(front_m + length_m));
    }
}

void check_approaches(const Scenario& scenario, Checker& check) {
    constexpr std::size_t kListedMax = 12;
    if (scenario.demand.approaches.empty() || network_kind(scenario.network).has_trips) return;
    const std::vector<std::string> known = approach_names(scenario.network);
    for (std::size_t k = 0; k < scenario.demand.approaches.size(); ++k) {
        const std::string& approach = scenario.demand.approaches[k];
        const auto matches = [&](const std::string& name) { return (name + "_in_").starts_with(approach + "_"); };
        if (std::any_of(known.begin(), known.end(), matches)) continue;
        check.error("demand.approaches[" + std::to_string(k) + "]", "no approach lane has a name that begins with '" +
                                                                        shortened(approach) + "_'" +
                                                                        known_names_hint(approach, known, kListedMax));
    }
}

void check_measured_area(const Scenario& scenario, Checker& check) {
    if (!network_kind(scenario.network).has_measured_area) return;
    double max_margin_m = scenario.measure.area_margin_m;
    std::string shortest_field;
    const auto compare = [&](const std::string& field, double length_m) {
        if (length_m == 0.0 || length_m >= max_margin_m) return;
        max_margin_m = length_m;
        shortest_field = field;
    };
    for (const OuterLeg& leg : network_kind(scenario.network).outer_legs(scenario.network)) {
        compare(leg.length_field, leg.length_m);
        compare(leg.exit_length_field, leg.exit_length_m);
    }
    if (shortest_field.empty()) return;
    check.error("measure.area_margin", "value " + metres(scenario.measure.area_margin_m) +
                                           " reaches beyond the end of the network: at most " + metres(max_margin_m) +
                                           ", the value of " + shortest_field);
}

namespace {

// Returns true if --e1 gives this id to a detector of the network itself, such as west_in_0_stop_line.
bool is_detector_id(const std::string& id, const LaneGraph& graph) {
    return std::any_of(graph.lanes.begin(), graph.lanes.end(), [&](const Lane& lane) {
        if (!id.starts_with(lane.name + "_")) return false;
        const std::string_view kind = std::string_view(id).substr(lane.name.size() + 1);
        return kind == "stop_line" || kind == "exit" || kind == "middle" || kind.starts_with("zone") ||
               kind.starts_with("signal");
    });
}

}  // namespace

void check_loops(const Scenario& scenario, Checker& check) {
    constexpr std::size_t kListedMax = 12;
    if (scenario.measure.loops.empty() || network_kind(scenario.network).has_trips) return;
    const LaneGraph graph = make_network(scenario.network);
    std::vector<std::string> known;
    for (const Lane& lane : graph.lanes) {
        if (lane.origin < 0) known.push_back(lane.name);
    }
    for (const LoopSettings& loop : scenario.measure.loops) {
        const std::string field = "measure.loops[" + loop.name + "].";
        if (is_detector_id(loop.name, graph))
            check.error(field + "name", "value '" + loop.name + "' is the id of a detector that --e1 lists anyway");
        const auto lane = std::find_if(graph.lanes.begin(), graph.lanes.end(),
                                       [&](const Lane& one) { return one.origin < 0 && one.name == loop.lane; });
        if (lane == graph.lanes.end()) {
            check.error(field + "lane",
                        "no lane has the name '" + loop.lane + "'" + known_names_hint(loop.lane, known, kListedMax));
            continue;
        }
        const double from_start_m = loop_position_m(loop, *lane);
        const double end_m = end_of_lane_m(*lane);
        if (from_start_m >= 0.0 && from_start_m <= end_m) continue;
        check.error(field + "position",
                    "value " + metres(loop.position_m) + " is not on the lane " + loop.lane + ": allowed are -" +
                        metres(end_m) + " to " + metres(end_m) +
                        (lane->signal_group >= 0 ? ", the length up to the stop line" : ", its length"));
    }
}

int cycles_within_duration(const Scenario& scenario) {
    constexpr double kRounding = 1e-9;
    const SignalSettings& signal = scenario.signal;
    const double cycles = (scenario.duration_s - signal.first_green_s) / scenario.nominal_cycle().cycle_s;
    return static_cast<int>(std::floor(cycles + kRounding)) - scenario.measure.warmup_cycles;
}

}  // namespace stopline
