#include "scenario/build_fleet.h"

#include <algorithm>
#include <functional>
#include <tuple>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "scenario/fleets.h"
#include "sim/mesoscale/following_families.h"
#include "spacing_laws/gap_policy.h"
#include "sumo_import/sumo_routes.h"

namespace stopline {

namespace {

// The vehicles that share policy, vehicle, driver and mesoscale parameters.
struct FleetClass {
    GapPolicySettings policy;
    PowertrainSettings vehicle;
    DriverSettings driver;
    MesoSettings meso;
    // Mesoscale mode: highest acceleration by speed; empty: the car-following model alone limits the acceleration.
    std::function<double(double speed_mps)> limit_mps2 = {};
};

FleetClass class_of(const Scenario& scenario, const PopulationSettings& population,
                    const PopulationSettings::Component& component) {
    const auto found = std::find_if(scenario.policies.begin(), scenario.policies.end(),
                                    [&](const GapPolicySettings& policy) { return policy.name == component.policy; });
    if (found == scenario.policies.end()) {
        throw InputError(fmt::format("population '{}': unknown policy '{}'", population.name, component.policy));
    }
    FleetClass fleet_class{*found, vehicle_of(scenario, component), driver_of(scenario, component), scenario.meso};
    fleet_class.policy.name = component_name(component);
    if (!component.vehicle && !component.driver) return fleet_class;
    // The own vehicle limits the acceleration to the available one, the own driver to that of its free driving.
    fleet_class.limit_mps2 = [own_vehicle = component.vehicle.has_value(), own_driver = component.driver.has_value(),
                              vehicle = compile_powertrain(fleet_class.vehicle),
                              free = fleet_class.driver.free_drive](double speed_mps) {
        constexpr double kUnlimited_mps2 = 1e9;
        const double available_mps2 =
            own_vehicle ? std::max(available_acceleration_mps2(vehicle, speed_mps), 0.0) : kUnlimited_mps2;
        const double wanted_mps2 =
            own_driver ? interpolate({free.speed_mps, free.acceleration_mps2}, speed_mps) : kUnlimited_mps2;
        return std::min(available_mps2, wanted_mps2);
    };
    return fleet_class;
}

void set_acceleration_and_braking(const SumoDriving& driving, double& acceleration_mps2, double& deceleration_mps2) {
    acceleration_mps2 = driving.acceleration_mps2;
    deceleration_mps2 = driving.deceleration_mps2;
}

// Sets the mesoscale parameters of a class to those of a vehicle type of SUMO.
void set_meso(const SumoDriving& driving, MesoSettings& meso) {
    KraussSettings krauss;
    set_acceleration_and_braking(driving, krauss.acceleration_mps2, krauss.deceleration_mps2);
    krauss.reaction_s = driving.time_gap_s;
    krauss.standstill_gap_m = driving.standstill_gap_m;
    krauss.dawdling = driving.dawdling;
    meso.constant_time = krauss;
    set_acceleration_and_braking(driving, meso.constant_distance.acceleration_mps2,
                                 meso.constant_distance.deceleration_mps2);
    set_acceleration_and_braking(driving, meso.idm.acceleration_mps2, meso.idm.deceleration_mps2);
    // Krauss::make() adds the difference between the gaps of the policy and the calibrated gaps. With these values, the
    // difference is 0 for a constant time gap. The gaps of policies with a constant distance do not change.
    meso.constant_distance.standstill_gap_m += driving.standstill_gap_m - meso.calibrated_standstill_gap_m;
    meso.calibrated_standstill_gap_m = driving.standstill_gap_m;
    meso.calibrated_time_gap_s = driving.time_gap_s;
}

// Returns the class of a component for the vehicles of one type of SUMO.
FleetClass with_type(FleetClass fleet_class, const SumoType& type) {
    const SumoDriving& driving = type.driving;
    fleet_class.vehicle.length_m = type.length_m;
    fleet_class.vehicle.maximum_speed_mps = std::min(fleet_class.vehicle.maximum_speed_mps, driving.maximum_speed_mps);
    FreeDriveSettings& free = fleet_class.driver.free_drive;
    for (double& a : free.acceleration_mps2) a = std::min(a, driving.acceleration_mps2);
    CaccSettings& cacc = fleet_class.driver.cacc;
    cacc.acceleration_max_mps2 = std::min(cacc.acceleration_max_mps2, driving.acceleration_mps2);
    StopSettings& stop = fleet_class.driver.stop;
    stop.deceleration_mps2 = std::min(stop.deceleration_mps2, driving.deceleration_mps2);
    set_meso(driving, fleet_class.meso);
    fleet_class.limit_mps2 = [limit = fleet_class.limit_mps2, a = driving.acceleration_mps2](double speed_mps) {
        return limit ? std::min(limit(speed_mps), a) : a;
    };
    if (fleet_class.policy.law != "constant_time") return fleet_class;
    fleet_class.policy.standstill_gap_m = driving.standstill_gap_m;
    set_law_parameter(fleet_class.policy, "time_gap", driving.time_gap_s);
    return fleet_class;
}

// Returns the vehicle types that apply to the trips, or null if the types of SUMO's files do not apply.
const SumoTraffic* types_of(const Scenario& scenario) {
    return scenario.demand.sumo && !scenario.demand.sumo->types.empty() ? scenario.demand.sumo.get() : nullptr;
}

// Returns all classes of a population: one for each component. If vehicle types of SUMO apply, returns one for each
// component and type, the types of the first component first.
std::vector<FleetClass> classes_of(const Scenario& scenario, const PopulationSettings& population) {
    const SumoTraffic* const traffic = types_of(scenario);
    std::vector<FleetClass> classes;
    for (const PopulationSettings::Component& component : population.components) {
        const FleetClass fleet_class = class_of(scenario, population, component);
        if (traffic == nullptr) {
            classes.push_back(fleet_class);
            continue;
        }
        for (const SumoType& type : traffic->types) classes.push_back(with_type(fleet_class, type));
    }
    return classes;
}

// Returns the index of `value` in the list, after adding it if the list does not have it.
template <class T>
int index_in(std::vector<T>& list, const T& value) {
    const auto found = std::find(list.begin(), list.end(), value);
    const auto index = static_cast<int>(found - list.begin());
    if (found == list.end()) list.push_back(value);
    return index;
}

DriverPlan driver_plan(const DriverSettings& settings, const PowertrainTables& vehicle, bool is_human, double step_s) {
    DriverPlan driver;
    driver.human = settings.human;
    driver.is_human = is_human;
    driver.tables = compile_driver(settings);
    const auto available_mps2 = [&](double v) { return available_acceleration_mps2(vehicle, v); };
    extend_by_power(settings.free_drive, available_mps2, driver.tables);
    driver.give_way = settings.give_way;
    driver.lane_change = settings.lane_change;
    driver.speed_advice = settings.speed_advice;
    driver.looks_ahead = settings.lane_change.looks_ahead();
    driver.gap_opening = settings.lane_change.gap_opening_value();
    driver.has_speed_advice = settings.speed_advice.is_on();
    driver.hesitation_s = is_human ? std::max(settings.free_drive.hesitation_s, settings.human.start_reaction_s)
                                   : settings.free_drive.hesitation_s;
    driver.hesitation_ticks = to_ticks(driver.hesitation_s, step_s);
    return driver;
}

// Adds the vehicle types and the drivers of all classes. A driver plan depends on the vehicle and on whether the driver
// is human, so each combination of vehicle, driver and human or automated driving has its own plan.
void add_vehicles_and_drivers(const std::vector<FleetClass>& classes, Model& model) {
    std::vector<PowertrainSettings> vehicles;
    std::vector<DriverSettings> drivers;
    std::vector<std::tuple<int, int, bool>> plans;  // indices in `vehicles` and `drivers`; true: human driver
    for (const FleetClass& fleet_class : classes) {
        const int vehicle = index_in(vehicles, fleet_class.vehicle);
        const int driver = index_in(drivers, fleet_class.driver);
        const bool is_human = find_gap_law(fleet_class.policy.law).is_human;
        model.classes.push_back({vehicle, index_in(plans, std::tuple(vehicle, driver, is_human))});
    }
    for (const PowertrainSettings& vehicle : vehicles) model.vehicles.push_back(compile_powertrain(vehicle));
    for (const auto& [vehicle, driver, is_human] : plans) {
        model.drivers.push_back(driver_plan(drivers[at(driver)], model.vehicles[at(vehicle)], is_human, model.step_s));
    }
    const auto limits_speed = [&](const PowertrainTables& vehicle) {
        return std::any_of(model.graph.lanes.begin(), model.graph.lanes.end(),
                           [&](const Lane& lane) { return vehicle.maximum_speed_mps < lane.limit_mps; });
    };
    model.has_speed_advice = std::any_of(model.drivers.begin(), model.drivers.end(),
                                         [](const DriverPlan& driver) { return driver.has_speed_advice; });
    model.has_speed_limiters = std::any_of(model.vehicles.begin(), model.vehicles.end(), limits_speed);
}

}  // namespace

void add_fleet(const Scenario& scenario, const PopulationSettings& population, Model& model) {
    const std::vector<FleetClass> classes = classes_of(scenario, population);
    for (const FleetClass& fleet_class : classes) model.policies.push_back(make_gap_policy(fleet_class.policy));
    add_vehicles_and_drivers(classes, model);
    for (const PopulationSettings::Component& component : population.components) {
        model.demand.policies.push_back(static_cast<int>(model.demand.policies.size()));
        model.demand.policy_shares.push_back(component.share);
    }
    using Pattern = PopulationSettings::Pattern;
    model.demand.pattern = population.pattern == Pattern::random     ? DemandPlan::Pattern::random
                           : population.pattern == Pattern::balanced ? DemandPlan::Pattern::balanced
                                                                     : DemandPlan::Pattern::alternating;
}

void add_following_models(const Scenario& scenario, const PopulationSettings& population, Model& model) {
    constexpr double kTop_mps = 40.0;
    constexpr double kUnlimited_mps2 = 1e9;
    const std::vector<FleetClass> classes = classes_of(scenario, population);
    model.following.clear();
    for (std::size_t k = 0; k < classes.size(); ++k) {
        model.following.push_back(
            make_following_model({classes[k].meso, classes[k].driver.human}, model.policies[k].meso));
    }
    const auto has_limit = [](const FleetClass& fleet_class) { return static_cast<bool>(fleet_class.limit_mps2); };
    if (std::none_of(classes.begin(), classes.end(), has_limit)) return;
    for (const FleetClass& fleet_class : classes) {
        const auto limit_mps2 = [&](double speed_mps) {
            return fleet_class.limit_mps2 ? fleet_class.limit_mps2(speed_mps) : kUnlimited_mps2;
        };
        model.acceleration_limits.push_back(tabulate_acceleration(limit_mps2, kTop_mps));
    }
}

void assign_trip_policies(const Scenario& scenario, Model& model) {
    model.demand.draw_trip_policies();
    const SumoTraffic* const traffic = types_of(scenario);
    if (traffic == nullptr) return;
    const auto types = static_cast<int>(traffic->types.size());
    std::vector<int>& policies = model.demand.trip_policies;
    for (std::size_t trip = 0; trip < policies.size(); ++trip) {
        policies[trip] = policies[trip] * types + traffic->type_of[trip];
    }
}

}  // namespace stopline
