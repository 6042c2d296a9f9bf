// The user's settings of the populations: the mix of vehicles in one run. SI units.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "driver/driver_settings.h"
#include "vehicle/powertrain_settings.h"

namespace stopline {

// A population: a mix of vehicles with one or several spacing policies. The shares of the components sum to 1.
struct PopulationSettings {
    enum class Pattern { alternating, random, balanced };
    // The vehicles with the same spacing policy, vehicle and driver.
    struct Component {
        std::string policy;
        double share = 1.0;
        std::optional<PowertrainSettings> vehicle = {};  // absent: Scenario::vehicle
        std::optional<DriverSettings> driver = {};       // absent: Scenario::driver
    };
    std::string name;
    std::vector<Component> components;
    Pattern pattern = Pattern::alternating;
};

}  // namespace stopline
