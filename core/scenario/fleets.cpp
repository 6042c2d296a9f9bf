#include "scenario/fleets.h"

#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>

#include "scenario/schema/quantity.h"

namespace stopline {
namespace {

std::string component_field(const PopulationSettings& population, std::size_t k) {
    return fmt::format("populations[{}].components[{}]", population.name, k);
}

// A setting in which all drivers of a population must agree.
struct CommonSetting {
    const char* field;
    const char* unit;
    double CaccSettings::*value;
};
constexpr std::array<CommonSetting, 4> kCommonSettings{{
    {"cacc.radar_delay", "ms", &CaccSettings::radar_delay_s},
    {"cacc.radar_range", "m", &CaccSettings::radar_range_m},
    {"cacc.v2v_delay", "ms", &CaccSettings::v2v_delay_s},
    {"cacc.deceleration_emergency", "m/s2", &CaccSettings::deceleration_emergency_mps2},
}};

void check_population(const Scenario& scenario, const PopulationSettings& population, Checker& check) {
    const CaccSettings& first = driver_of(scenario, population.components.front()).cacc;
    for (std::size_t k = 1; k < population.components.size(); ++k) {
        const CaccSettings& own = driver_of(scenario, population.components[k]).cacc;
        for (const CommonSetting& setting : kCommonSettings) {
            const double value = own.*setting.value;
            if (value == first.*setting.value) continue;
            check.error(component_field(population, k) + ".driver",
                        fmt::format("{} is {}, but the first component of the population has {}: all drivers of a "
                                    "population must have the same value",
                                    setting.field, short_text(value, unit(setting.unit)),
                                    short_text(first.*setting.value, unit(setting.unit))));
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

std::string component_name(const PopulationSettings::Component& component) {
    std::string name = component.policy;
    if (component.vehicle) name += "_" + component.vehicle->name;
    if (component.driver) name += "_" + component.driver->name;
    return name;
}

void check_fleets(const Scenario& scenario, Checker& check) {
    for (const PopulationSettings& population : scenario.populations) check_population(scenario, population, check);
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
    for (const PopulationSettings& population : scenario.populations) {
        for (const PopulationSettings::Component& component : population.components) {
            longest_m = std::max(longest_m, vehicle_of(scenario, component).length_m);
        }
    }
    return longest_m;
}

}  // namespace stopline
