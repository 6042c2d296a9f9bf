#include "scenario/network_checks.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/arithmetic.h"
#include "network/arm_names.h"
#include "network/outer_arms.h"
#include "scenario/nearest_name.h"
#include "scenario/quantity.h"

namespace stopline {
namespace {

constexpr double kRounding_m = 1e-9;

std::string metres(double value) { return short_text(value, unit("m")); }

// The largest standstill gap among the policies that some population uses.
double longest_standstill_gap_m(const Scenario& scenario) {
    double longest_m = 0.0;
    for (const GapPolicySettings& policy : scenario.policies) {
        for (const PopulationSettings& population : scenario.populations) {
            for (const auto& component : population.components) {
                if (component.policy == policy.name) longest_m = std::max(longest_m, policy.standstill_gap_m);
            }
        }
    }
    return longest_m;
}

double place_m(const Scenario& scenario) { return scenario.vehicle.length_m + longest_standstill_gap_m(scenario); }

// With the braking that drivers accept on yellow, and what the brake's lag and the change of the request cost (sim/stops.cpp); up to
// whole decimetres, so that messages name what is accepted.
double stopping_m(const Scenario& scenario, double speed_mps) {
    const double b = scenario.driver.stop.decision_deceleration_mps2;
    const double late_s = scenario.vehicle.brake_lag_s + 0.5 * b / scenario.driver.cacc.jerk_down_mps3;
    return std::ceil(10.0 * (speed_mps * late_s + square(speed_mps) / (2.0 * b))) / 10.0;
}

std::string stopping_text(const Scenario& scenario, double speed_mps) {
    return "to stop from " + short_text(speed_mps, unit("km/h")) + " at " +
           short_text(scenario.driver.stop.decision_deceleration_mps2, unit("m/s2")) +
           " (driver.stop.decision_deceleration)";
}

}  // namespace

void check_queue(const Scenario& scenario, Checker& check) {
    if (scenario.network.kind != "approach" || scenario.demand.kind != "queue") return;
    const double queue_m = scenario.demand.vehicles * place_m(scenario) + scenario.driver.stop.margin_m;
    if (scenario.network.approach.length_m >= queue_m) return;
    check.error("network.approach.length",
                "a queue of " + std::to_string(scenario.demand.vehicles) + " vehicles a lane is " + metres(queue_m) +
                    " long, longer than the approach of " + metres(scenario.network.approach.length_m));
}

void check_grid_links(const Scenario& scenario, Checker& check) {
    if (scenario.network.kind != "grid") return;
    const GridSettings& grid = scenario.network.grid;
    const IntersectionSettings& layout = scenario.network.intersection;
    const double least_m = std::max(place_m(scenario), stopping_m(scenario, layout.speed_limit_mps));
    const auto look = [&](const std::string& field, double spacing_m) {
        const double least_spacing_m = 2.0 * layout.radius_m + least_m;
        if (spacing_m >= least_spacing_m - kRounding_m) return;
        check.error("network.grid." + field,
                    "value " + metres(spacing_m) + " leaves " + metres(spacing_m - 2.0 * layout.radius_m) +
                        " of road between intersections of network.intersection.radius = " + metres(layout.radius_m) +
                        ": at least " + metres(least_spacing_m) +
                        " with this radius, as a vehicle with its gap needs " + metres(place_m(scenario)) + ", and " +
                        metres(stopping_m(scenario, layout.speed_limit_mps)) + " " +
                        stopping_text(scenario, layout.speed_limit_mps));
    };
    if (grid.columns > 1) look("column_spacing", grid.column_spacing_m);
    if (grid.rows > 1) look("row_spacing", grid.row_spacing_m);
}

// In a pocket that is shorter than a vehicle nobody would find room to change to it.
void check_pockets(const Scenario& scenario, Checker& check) {
    for (const StreetIntersection& node : scenario.network.streets.intersections) {
        for (std::size_t a = 0; a < node.arms.size(); ++a) {
            for (std::size_t k = 0; k < node.arms[a].lanes.size(); ++k) {
                const double pocket_m = node.arms[a].lanes[k].pocket_m;
                if (pocket_m == 0.0 || pocket_m >= place_m(scenario) - kRounding_m) continue;
                check.error("network.streets.intersections[" + node.name + "].arms[" + std::to_string(a) + "].lanes[" +
                                std::to_string(k) + "].pocket",
                            "value " + metres(pocket_m) + " is too short for a vehicle of " +
                                metres(scenario.vehicle.length_m) + " and its standstill gap: at least " +
                                metres(place_m(scenario)) + ", or 0 m for a lane as long as the approach");
            }
        }
    }
}

void check_entries(const Scenario& scenario, Checker& check) {
    for (const OuterArm& arm : outer_arms(scenario.network)) {
        const double speed_mps = std::min(scenario.demand.entry_speed_mps, arm.limit_mps);
        const double needs_m = stopping_m(scenario, speed_mps);
        if (arm.length_m == 0.0 || arm.length_m >= needs_m) continue;
        check.error(arm.length_field, "value " + metres(arm.length_m) + " is too short " +
                                          stopping_text(scenario, speed_mps) + " before the line: at least " +
                                          metres(needs_m) + ", or a lower demand.entry_speed than " +
                                          short_text(scenario.demand.entry_speed_mps, unit("km/h")));
    }
}

void check_arms(const Scenario& scenario, Checker& check) {
    constexpr std::size_t kListed = 12;
    if (scenario.demand.arms.empty() || scenario.network.is_sumo()) return;
    const std::vector<std::string> known = arm_names(scenario.network);
    for (std::size_t k = 0; k < scenario.demand.arms.size(); ++k) {
        const std::string& arm = scenario.demand.arms[k];
        const auto begins = [&](const std::string& name) { return (name + "_in_").starts_with(arm + "_"); };
        if (std::any_of(known.begin(), known.end(), begins)) continue;
        check.error("demand.arms[" + std::to_string(k) + "]",
                    "no lane to an intersection has a name that begins with '" + shortened(arm) + "_'" +
                        known_names(arm, known, kListed));
    }
}

void check_measured_area(const Scenario& scenario, Checker& check) {
    if (!scenario.network.has_several()) return;
    double most_m = scenario.measure.outside_m;
    std::string shortest;
    const auto look = [&](const std::string& field, double length_m) {
        if (length_m == 0.0 || length_m >= most_m) return;
        most_m = length_m;
        shortest = field;
    };
    for (const OuterArm& arm : outer_arms(scenario.network)) {
        look(arm.length_field, arm.length_m);
        look(arm.exit_length_field, arm.exit_length_m);
    }
    if (shortest.empty()) return;
    check.error("measure.outside", "value " + metres(scenario.measure.outside_m) +
                                       " lies beyond the end of the network: at most " + metres(most_m) + ", " +
                                       shortest);
}

}  // namespace stopline
