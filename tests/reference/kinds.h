// The kinds of vehicles of the reference engine. The vehicles with one policy share their vehicle type and their
// driver.
#pragma once

#include <optional>

#include "reference/driver.h"
#include "reference/meso.h"
#include "reference/powertrain.h"
#include "scenario/fleets.h"
#include "sim/state/model.h"

namespace stopline::reference_engine {

inline std::int64_t ticks_in(double seconds, double step_s) { return std::llround(seconds / step_s); }

struct VehicleKind {
    GapPolicy policy;
    VehicleModel vehicle;
    DriverModel driver;
    bool is_human = false;
    double length_m = 0.0;
    double standstill_gap_m = 0.0;      // of the policy
    std::int64_t hesitation_ticks = 0;  // reaction time of the first vehicle at a stop line

    const DriverSettings& settings() const { return driver.settings; }
};

// Returns one kind for each component of the first population.
inline std::vector<VehicleKind> make_kinds(const Scenario& scenario) {
    std::vector<VehicleKind> kinds;
    for (const auto& component : scenario.populations.front().components) {
        const auto is_named = [&](const GapPolicySettings& policy) { return policy.name == component.policy; };
        VehicleKind kind;
        kind.policy = make_gap_policy(*std::find_if(scenario.policies.begin(), scenario.policies.end(), is_named));
        kind.vehicle = make_vehicle_model(vehicle_of(scenario, component));
        const DriverSettings& driver = driver_of(scenario, component);
        kind.driver = make_driver_model(driver, kind.vehicle);
        kind.is_human = kind.policy.law->is_human;
        kind.length_m = kind.vehicle.settings.length_m;
        kind.standstill_gap_m = stored(kind.policy.settings.standstill_gap_m);
        double hesitation_s = driver.free_drive.hesitation_s;
        if (kind.is_human) hesitation_s = std::max(hesitation_s, driver.human.start_reaction_s);
        if (scenario.is_meso()) hesitation_s += scenario.meso.start_delay_s;
        kind.hesitation_ticks = ticks_in(hesitation_s, scenario.tick_s());
        kinds.push_back(std::move(kind));
    }
    return kinds;
}

// Returns the highest acceleration of a component in the mesoscale mode: that of its own vehicle, and that of the free
// driving of its own driver. A component without either has no limit.
inline double fastest_mps2(const PopulationSettings::Component& component, const VehicleKind& kind, double speed_mps) {
    double result = 1e9;
    if (component.vehicle) result = std::max(available_mps2(kind.vehicle, speed_mps), 0.0);
    if (component.driver) {
        const FreeDriveSettings& free = kind.settings().free_drive;
        result = std::min(result, interpolated(free.speed_mps, free.acceleration_mps2, speed_mps));
    }
    return result;
}

inline MesoModel make_meso_model(const Scenario& scenario, const Model& model, const std::vector<VehicleKind>& kinds,
                                 const UndocumentedRules& rules) {
    constexpr std::size_t kBins = 64;
    MesoModel meso;
    meso.settings = scenario.meso;
    meso.driver = kinds.front().settings();
    meso.step_s = scenario.meso.step_s;
    meso.dawdling_key = dawdle_key(scenario.seed);
    meso.driver_key = driver_key(scenario.seed);
    if (!model.graph.approaches.empty()) meso.hardest_mps2 = meso.driver.cacc.deceleration_emergency_mps2;
    const auto& components = scenario.populations.front().components;
    const bool has_limits = std::any_of(components.begin(), components.end(),
                                        [](const auto& component) { return component.vehicle || component.driver; });
    bool has_power_limit = false;
    bool has_idm = false;
    for (std::size_t k = 0; k < kinds.size(); ++k) {
        MesoPolicy policy = make_meso_policy(scenario.meso, kinds[k].policy);
        policy.driver = kinds[k].settings();
        if (policy.is_human) policy.idm = policy.driver.human.idm;
        if (model.has_speed_limiters) policy.maximum_mps = kinds[k].vehicle.settings.maximum_speed_mps;
        for (std::size_t bin = 0; has_limits && bin < kBins; ++bin) {
            const double middle_mps = (static_cast<double>(bin) + 0.5) * kFastestTop_mps / kBins;
            policy.fastest_mps2.push_back(fastest_mps2(components[k], kinds[k], middle_mps));
        }
        has_power_limit |= policy.settings.constant_power_speed_mps < 100.0;
        has_idm |= policy.is_idm;
        meso.policies.push_back(std::move(policy));
    }
    meso.bounds_followers_by_power = has_power_limit || has_idm || !rules.power_bound_needs_power_limit;
    tabulate_profiles(kinds.front().vehicle, meso);
    return meso;
}

}  // namespace stopline::reference_engine
