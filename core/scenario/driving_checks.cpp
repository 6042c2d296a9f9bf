#include "scenario/driving_checks.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/simd/arithmetic.h"
#include "base/units.h"
#include "driver/following_model.h"
#include "scenario/fleets.h"
#include "scenario/kinds/network_kind.h"
#include "scenario/schema/quantity.h"
#include "sim/mesoscale/following_families.h"
#include "spacing_laws/gap_policy.h"
#include "v2v/platoon_length.h"

namespace stopline {
namespace {

constexpr double kRounding = 1e-9;

bool is_used(const Scenario& scenario, const GapPolicySettings& policy) {
    const auto names_policy = [&](const PopulationSettings::Component& c) { return c.policy == policy.name; };
    return std::any_of(scenario.populations.begin(), scenario.populations.end(), [&](const PopulationSettings& p) {
        return std::any_of(p.components.begin(), p.components.end(), names_policy);
    });
}

// Mesoscale mode: returns by how much the gap of a stopped vehicle can fall below the standstill gap of its policy, m.
// Vehicles can touch if the standstill gap is smaller than the result.
double meso_min_gap_m(const Scenario& scenario, const GapPolicySettings& policy) {
    return policy.standstill_gap_m -
           make_following_model({scenario.meso, scenario.driver.human}, make_gap_policy(policy).meso).smallest_gap_m();
}

std::vector<std::string> following_names() {
    std::vector<std::string> names;
    for (const FollowingFamily& family : following_families()) names.emplace_back(family.text.name);
    return names;
}

void check_policies(const Scenario& scenario, Checker& check) {
    for (const GapPolicySettings& policy : scenario.policies) {
        if (!is_used(scenario, policy)) continue;
        if (scenario.is_meso() && make_gap_policy(policy).meso.family.empty()) {
            check.error(
                "policies[" + policy.name + "].mesoscale",
                "is '" + std::string(kFamilyByLaw) + "', but the law '" + policy.law +
                    "' names no car-following model and the run is mesoscale (fidelity: meso): give the model (" +
                    fmt::format("{}", fmt::join(following_names(), ", ")) + ")");
            continue;
        }
        const std::string field = "policies[" + policy.name + "].standstill_gap";
        const std::string value = "value " + short_text(policy.standstill_gap_m, unit("m")) + " is too small";
        if (!scenario.is_meso()) {
            if (policy.standstill_gap_m >= kMinStandstillGap_m - kRounding) continue;
            check.error(field, value + ": in full dynamics at least " + short_text(kMinStandstillGap_m, unit("m")) +
                                   ", because followers lose up to 1.3 m in a hard stop");
        } else if (const double min_m = meso_min_gap_m(scenario, policy); policy.standstill_gap_m < min_m - kRounding) {
            check.error(field, value + ": with the mesoscale parameters '" + scenario.meso.name +
                                   "' vehicles come nearer by up to " + short_text(min_m, unit("m")));
        }
    }
}

// A vehicle with its driver, and the field that gives the vehicle, such as "vehicle".
struct DrivenVehicle {
    std::string field;
    const PowertrainSettings& vehicle;
    const DriverSettings& driver;
};

void check_tyres(const DrivenVehicle& driven, Checker& check) {
    const double tyres_mps2 = driven.vehicle.brake_friction * kGravity_mps2;
    const double needed_mps2 = driven.driver.cacc.deceleration_emergency_mps2;
    if (tyres_mps2 >= needed_mps2) return;
    check.error(driven.field + ".brake_friction", "the tyres give " + short_text(tyres_mps2, unit("m/s2")) +
                                                      ", but drivers count on driver.cacc.deceleration_emergency, " +
                                                      short_text(needed_mps2, unit("m/s2")) +
                                                      ": use a higher friction or more careful drivers");
}

void check_lags(const DrivenVehicle& driven, Checker& check) {
    const PowertrainSettings& car = driven.vehicle;
    const double longest_s = driven.driver.cacc.prediction_end_s;
    const auto compare = [&](const std::string& field, double lag_s) {
        if (lag_s <= longest_s + kRounding) return;
        check.error(field, "a lag of " + short_text(lag_s, unit("s")) +
                               " is longer than the controller foresees: at most driver.cacc.prediction_end, " +
                               short_text(longest_s, unit("s")));
    };
    compare(driven.field + ".brake_lag", car.brake_lag_s);
    if (car.lag_drive_s.empty() || car.lag_gear_factor.empty()) return;
    compare(driven.field + ".lag_times", *std::max_element(car.lag_drive_s.begin(), car.lag_drive_s.end()) *
                                             *std::max_element(car.lag_gear_factor.begin(), car.lag_gear_factor.end()));
}

// Returns the largest distance in m by which a vehicle of the component drives beyond the place where it wants to stop.
//
// Mesoscale mode: before a stop with the remaining distance r, the speed of the next step is
//     v(r) = sqrt((b tau)^2 + 2 b r) - b tau
// with the deceleration b and the reaction time tau of the model. The vehicle drives v(r) dt in the step dt. This can
// be further than r. In each later step, the speed falls by at most e dt, with the emergency deceleration e of the
// driver. In n steps from the speed v on, the vehicle thus drives n v dt - n (n - 1) / 2 e dt^2. The remaining distance
// was r = v^2 / (2 b) + tau v. The difference is greatest for v = b (n dt - tau). For n = 1 it is b (dt - tau)^2 / 2 if
// dt > tau. If dt <= tau and b <= e, the vehicle stops in time.
double stop_overshoot_m(const Scenario& scenario, const PopulationSettings::Component& component) {
    const auto policy = std::find_if(scenario.policies.begin(), scenario.policies.end(),
                                     [&](const GapPolicySettings& one) { return one.name == component.policy; });
    if (policy == scenario.policies.end()) return 0.0;
    const MesoGap gap = make_gap_policy(*policy).meso;
    if (gap.family.empty()) return 0.0;
    const DriverSettings& driver = driver_of(scenario, component);
    const FollowingBraking braking = make_following_model({scenario.meso, driver.human}, gap).braking();
    const double b = std::min(braking.deceleration_mps2, driver.stop.deceleration_mps2);
    const double step_s = scenario.meso.step_s;
    const double step_braking_mps = driver.cacc.deceleration_emergency_mps2 * step_s;
    const double highest_mps = vehicle_of(scenario, component).maximum_speed_mps;
    double overshoot_m = 0.0;
    for (int n = 1;; ++n) {
        const double speed_mps = std::min(b * (n * step_s - braking.reaction_s), highest_mps);
        if (speed_mps <= (n - 1) * step_braking_mps) return overshoot_m;  // stopped before the n-th step
        const double driven_m = n * step_s * (speed_mps - 0.5 * (n - 1) * step_braking_mps);
        const double remaining_m = speed_mps * (0.5 * speed_mps / b + braking.reaction_s);
        overshoot_m = std::max(overshoot_m, driven_m - remaining_m);
    }
}

// Checks that the margins before stop lines and conflict areas are longer than a vehicle can overshoot its stop.
// `field`: the field of the driver, such as "driver".
void check_stop_margins(const Scenario& scenario, const DriverSettings& driver, double overshoot_m,
                        const std::string& field, Checker& check) {
    constexpr double kReserve_m = 0.001;  // so that rounding does not put a vehicle at rest beyond the margin
    const double min_m = std::ceil(1000.0 * (overshoot_m + kReserve_m) - kRounding) / 1000.0;
    const auto compare = [&](const std::string& name, double margin_m) {
        if (margin_m >= min_m - kRounding) return;
        check.error(field + name,
                    fmt::format("value {} is too small: with meso.step = {}, vehicles can stop {} too "
                                "late. Give at least {}, or a shorter step",
                                short_text(margin_m, unit("m")), short_text(scenario.meso.step_s, unit("s")),
                                short_text(overshoot_m, unit("m")), short_text(min_m, unit("m"))));
    };
    compare(".stop.margin", driver.stop.margin_m);
    if (network_kind(scenario.network).run != kRunAsSingleLight) compare(".give_way.margin", driver.give_way.margin_m);
}

// Full dynamics: checks that vehicles come to rest before a conflict area. Their control ends a stop with an error far
// below this margin, but the front of a vehicle at rest exactly at the area would count as inside.
void check_give_way_margin(const Scenario& scenario, const DriverSettings& driver, const std::string& field,
                           Checker& check) {
    constexpr double kMinMargin_m = 0.01;
    if (network_kind(scenario.network).run == kRunAsSingleLight) return;
    if (driver.give_way.margin_m >= kMinMargin_m - kRounding) return;
    check.error(field + ".give_way.margin",
                fmt::format("value {} is too small: in full dynamics vehicles can creep into "
                            "a conflict area from there. Give at least {}",
                            short_text(driver.give_way.margin_m, unit("m")), short_text(kMinMargin_m, unit("m"))));
}

// Mesoscale mode: checks the margins of all drivers.
void check_stops(const Scenario& scenario, Checker& check) {
    struct Stop {
        const DriverSettings* driver = nullptr;
        double overshoot_m = 0.0;
    };
    std::map<std::string, Stop> stops;  // by the field of the driver, which several components can share
    for (const PopulationSettings& population : scenario.populations) {
        for (std::size_t k = 0; k < population.components.size(); ++k) {
            const PopulationSettings::Component& component = population.components[k];
            const std::string field =
                component.driver ? fmt::format("populations[{}].components[{}].driver", population.name, k) : "driver";
            Stop& stop = stops[field];
            stop.driver = &driver_of(scenario, component);
            stop.overshoot_m = std::max(stop.overshoot_m, stop_overshoot_m(scenario, component));
        }
    }
    for (const auto& [field, stop] : stops) check_stop_margins(scenario, *stop.driver, stop.overshoot_m, field, check);
}

constexpr double kLimitRounding = 1.001;

std::string kmh(double speed_mps) { return short_text(speed_mps, unit("km/h")); }

// Returns true if a population uses a policy whose vehicles pass on V2V start messages.
bool relays_starts(const Scenario& scenario) {
    return std::any_of(scenario.policies.begin(), scenario.policies.end(), [&](const GapPolicySettings& policy) {
        return is_used(scenario, policy) &&
               make_following_model({scenario.meso, scenario.driver.human}, make_gap_policy(policy).meso)
                   .relays_starts();
    });
}

std::string beyond_text(double limit_mps, double range_mps, const std::string& data, const std::string& field,
                        double power_share) {
    return fmt::format(
        "speed limits up to {} are beyond the data of {}, which hold up to {} ({}): on faster roads vehicles accelerate "
        "with at least {:g} % of what they can give (driver.free_drive.power_share)",
        kmh(limit_mps), data, kmh(range_mps), field, 100.0 * power_share);
}

}  // namespace

void check_gaps(const Scenario& scenario, Checker& check) {
    check_policies(scenario, check);
    if (scenario.is_meso()) return check_stops(scenario, check);
    const auto check_driven = [&](const DrivenVehicle& driven) {
        check_tyres(driven, check);
        check_lags(driven, check);
    };
    check_driven({"vehicle", scenario.vehicle, scenario.driver});
    check_give_way_margin(scenario, scenario.driver, "driver", check);
    for (const PopulationSettings& population : scenario.populations) {
        for (std::size_t k = 0; k < population.components.size(); ++k) {
            const PopulationSettings::Component& component = population.components[k];
            if (!component.vehicle && !component.driver) continue;
            const std::string field = fmt::format("populations[{}].components[{}].vehicle", population.name, k);
            check_driven({field, vehicle_of(scenario, component), driver_of(scenario, component)});
            if (!component.driver) continue;
            check_give_way_margin(scenario, driver_of(scenario, component),
                                  fmt::format("populations[{}].components[{}].driver", population.name, k), check);
        }
    }
}

std::vector<std::string> range_warnings(const Scenario& scenario) {
    std::vector<std::string> lines;
    const FreeDriveSettings& free = scenario.driver.free_drive;
    const double limit_mps = network_kind(scenario.network).highest_limit_mps(scenario.network);
    const double driver_range_mps = free.profile_limit_mps > 0.0 ? free.profile_limit_mps : free.speed_mps.back();
    const MesoSettings& meso = scenario.meso;
    if (!scenario.is_meso()) {
        if (limit_mps > kLimitRounding * scenario.driver.cacc.catch_up_factor * driver_range_mps) {
            lines.push_back(beyond_text(limit_mps, driver_range_mps, "driver '" + scenario.driver_name + "'",
                                        "driver.free_drive.profile_limit", free.power_share));
        }
        const V2vSettings& v2v = scenario.driver.v2v;
        const double age_s = scenario.driver.cacc.v2v_delay_s + v2v.jitter_s + message_interval_s(v2v, scenario.step_s);
        if (v2v.topology == "predecessor_and_leader" && age_s > kLongestPlatoonLeaderAge_s) {
            lines.push_back(fmt::format(
                "messages of the platoon leader are up to {:.0f} ms old, but followers use them up to {:.0f} ms: they "
                "alternate between the modes platoon_leader and messages (driver.v2v.interval)",
                1000.0 * age_s, 1000.0 * kLongestPlatoonLeaderAge_s));
        }
        return lines;
    }
    const DriverSettings& driver = scenario.driver;
    const auto without_effect = [&](const char* field) {
        lines.push_back(
            fmt::format("{} has no effect in the mesoscale mode, where a V2V channel changes only the starts "
                        "of queues, cooperative clearing and cooperative gap opening",
                        field));
    };
    if (driver.v2v.topology != V2vSettings{}.topology) without_effect("driver.v2v.topology");
    if (driver.v2v.fallback != FallbackSettings{}) without_effect("driver.v2v.fallback");
    if (driver.platoon.max_vehicles != kAnyLength && !relays_starts(scenario)) {
        lines.emplace_back(
            "driver.platoon.max_vehicles has no effect: no vehicle keeps a constant distance (the model "
            "constant_distance of the mesoscale mode)");
    }
    if (limit_mps > kLimitRounding * meso.calibrated_speed_limit_mps) {
        lines.push_back(beyond_text(limit_mps, meso.calibrated_speed_limit_mps,
                                    "the mesoscale parameters '" + meso.name + "'", "meso.calibrated_speed_limit",
                                    free.power_share));
    }
    if (meso.step_s > kLimitRounding * meso.calibrated_step_s && relays_starts(scenario)) {
        lines.push_back(fmt::format(
            "meso.step of {} is longer than the step of {} for which '{}' was calibrated (meso.calibrated_step): each "
            "vehicle starts a step after its leader, so queues of constant-distance policies discharge too slowly",
            short_text(meso.step_s, unit("ms")), short_text(meso.calibrated_step_s, unit("ms")), meso.name));
    }
    return lines;
}

}  // namespace stopline
