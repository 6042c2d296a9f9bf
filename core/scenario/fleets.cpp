#include "scenario/fleets.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "scenario/driving_checks.h"
#include "scenario/kinds/network_kind.h"
#include "scenario/schema/quantity.h"
#include "spacing_laws/gap_policy.h"

namespace stopline {
namespace {

std::string component_field(const PopulationSettings& population, std::size_t k) {
    return fmt::format("populations[{}].components[{}]", population.name, k);
}

// A setting in which all drivers of a population must agree.
struct CommonSetting {
    const char* field = "";
    const char* unit = "";
    double (*value)(const DriverSettings& driver) = nullptr;
};
constexpr std::array<CommonSetting, 4> kCommonSettings{{
    {"cacc.radar_delay", "ms", [](const DriverSettings& d) { return d.cacc.radar_delay_s; }},
    {"cacc.radar_range", "m", [](const DriverSettings& d) { return d.cacc.radar_range_m; }},
    {"cacc.v2v_delay", "ms", [](const DriverSettings& d) { return d.cacc.v2v_delay_s; }},
    {"cacc.deceleration_emergency", "m/s2", [](const DriverSettings& d) { return d.cacc.deceleration_emergency_mps2; }},
}};

void check_population(const Scenario& scenario, const PopulationSettings& population, Checker& check) {
    const DriverSettings& first = driver_of(scenario, population.components.front());
    const DriverSettings v2v_driver = v2v_driver_of(scenario, population);
    for (std::size_t k = 1; k < population.components.size(); ++k) {
        const DriverSettings& own = driver_of(scenario, population.components[k]);
        const auto differs = [&](const char* field) {
            check.error(component_field(population, k) + ".driver",
                        fmt::format("{0} differs from that of another component of the population: all drivers of a "
                                    "population must have the same values, or leave {0} out",
                                    field));
        };
        if (own.v2v != v2v_driver.v2v && own.v2v != V2vSettings{}) differs("v2v");
        if (own.platoon != v2v_driver.platoon && own.platoon != PlatoonSettings{}) differs("platoon");
        for (const CommonSetting& setting : kCommonSettings) {
            const double value = setting.value(own);
            const double first_value = setting.value(first);
            if (value == first_value) continue;
            check.error(component_field(population, k) + ".driver",
                        fmt::format("{} is {}, but the first component of the population has {}: all drivers of a "
                                    "population must have the same value",
                                    setting.field, short_text(value, unit(setting.unit)),
                                    short_text(first_value, unit(setting.unit))));
        }
    }
}

// Returns the policy of a component; null if there is none with its name, which another check reports.
const GapPolicySettings* policy_of(const Scenario& scenario, const PopulationSettings::Component& component) {
    const auto found = std::find_if(scenario.policies.begin(), scenario.policies.end(),
                                    [&](const GapPolicySettings& policy) { return policy.name == component.policy; });
    return found == scenario.policies.end() ? nullptr : &*found;
}

void find_late_brakes(const Scenario& scenario, const PopulationSettings& population,
                      std::vector<FieldProblem>& problems) {
    constexpr double kSpeedStep_mps = 1.0;
    constexpr double kRounding_m = 1e-9;
    double shortest_s = std::numeric_limits<double>::infinity();
    for (const PopulationSettings::Component& component : population.components) {
        shortest_s = std::min(shortest_s, vehicle_of(scenario, component).brake_lag_s);
    }
    for (std::size_t k = 0; k < population.components.size(); ++k) {
        const PopulationSettings::Component& component = population.components[k];
        const double later_s = vehicle_of(scenario, component).brake_lag_s - shortest_s;
        const GapPolicySettings* const policy = policy_of(scenario, component);
        if (later_s <= 0.0 || policy == nullptr) continue;
        const double limit_mps = network_kind(scenario.network).highest_limit_mps(scenario.network);
        const int steps = static_cast<int>(std::ceil(limit_mps / kSpeedStep_mps));
        for (int step = 0; step <= steps; ++step) {
            const double speed_mps = std::min(step * kSpeedStep_mps, limit_mps);
            const double needed_m = kMinStandstillGap_m + later_s * speed_mps;
            if (equilibrium_gap_m(*policy, speed_mps) >= needed_m - kRounding_m) continue;
            problems.emplace_back(
                component_field(population, k) + ".policy",
                fmt::format("the brakes of '{}' respond {} later than those of other vehicles of the "
                            "population, so its gap at {} must be at least {}: use a policy with a larger gap",
                            vehicle_of(scenario, component).name, short_text(later_s, unit("ms")),
                            short_text(speed_mps, unit("km/h")), short_text(needed_m, unit("m"))));
            break;
        }
    }
}

}  // namespace

const PowertrainSettings& vehicle_of(const Scenario& scenario, const PopulationSettings::Component& component) {
    return component.vehicle ? *component.vehicle : scenario.vehicle;
}

const DriverSettings& driver_of(const Scenario& scenario, const PopulationSettings::Component& component) {
    return component.driver ? *component.driver : scenario.driver;
}

DriverSettings v2v_driver_of(const Scenario& scenario, const PopulationSettings& population) {
    DriverSettings driver = driver_of(scenario, population.components.front());
    for (const PopulationSettings::Component& component : population.components) {
        const DriverSettings& own = driver_of(scenario, component);
        if (driver.v2v == V2vSettings{}) driver.v2v = own.v2v;
        if (driver.platoon == PlatoonSettings{}) driver.platoon = own.platoon;
    }
    return driver;
}

bool any_driver(const Scenario& scenario, bool (*has)(const DriverSettings& driver)) {
    const std::vector<const PopulationSettings::Component*> components = all_components(scenario);
    return has(scenario.driver) || std::any_of(components.begin(), components.end(), [&](const auto* component) {
               return has(driver_of(scenario, *component));
           });
}

std::vector<const PopulationSettings::Component*> all_components(const Scenario& scenario) {
    std::vector<const PopulationSettings::Component*> components;
    for (const PopulationSettings& population : scenario.populations) {
        for (const PopulationSettings::Component& component : population.components) components.push_back(&component);
    }
    return components;
}

std::string component_name(const PopulationSettings::Component& component) {
    std::string name = component.policy;
    if (component.vehicle) name += "_" + component.vehicle->name;
    if (component.driver) name += "_" + component.driver->name;
    return name;
}

void check_fleets(const Scenario& scenario, Checker& check) {
    for (const PopulationSettings& population : scenario.populations) check_population(scenario, population, check);
    for (const auto& [field, problem] : late_brake_problems(scenario)) check.error(field, problem);
}

std::vector<FieldProblem> late_brake_problems(const Scenario& scenario) {
    std::vector<FieldProblem> problems;
    if (scenario.is_meso()) return problems;
    for (const PopulationSettings& population : scenario.populations) find_late_brakes(scenario, population, problems);
    return problems;
}

double mean_vehicle_m(const Scenario& scenario, const PopulationSettings& population) {
    double mean_m = 0.0;
    for (const PopulationSettings::Component& component : population.components) {
        mean_m += component.share * vehicle_of(scenario, component).length_m;
    }
    return mean_m;
}

double longest_vehicle_m(const Scenario& scenario) {
    double longest_m = 0.0;
    for (const PopulationSettings::Component* component : all_components(scenario)) {
        longest_m = std::max(longest_m, vehicle_of(scenario, *component).length_m);
    }
    return longest_m;
}

}  // namespace stopline
