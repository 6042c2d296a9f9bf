// The vehicles and drivers of populations, and the checks of populations with several of them.
#pragma once

#include <string>
#include <vector>

#include "scenario/import_sumo.h"
#include "scenario/scenario.h"
#include "scenario/schema/report.h"

namespace stopline {

// Returns the vehicle or the driver of a component: its own one, or that of the scenario.
const PowertrainSettings& vehicle_of(const Scenario& scenario, const PopulationSettings::Component& component);
const DriverSettings& driver_of(const Scenario& scenario, const PopulationSettings::Component& component);

// Returns true if the driver of the scenario or of any component has a property.
bool any_driver(const Scenario& scenario, bool (*has)(const DriverSettings& driver));

// Returns the driver of the first component of a population, with the V2V and platoon settings of the first component
// that sets them. These settings apply to all vehicles of the population.
DriverSettings v2v_driver_of(const Scenario& scenario, const PopulationSettings& population);

// Returns the components of all populations. The pointers are valid as long as the scenario.
std::vector<const PopulationSettings::Component*> all_components(const Scenario& scenario);

// Returns the name of the vehicles of a component: the policy, then the vehicle and the driver if the component has its
// own ones, such as "CDG_rigid_lorry_12t".
std::string component_name(const PopulationSettings::Component& component);

// Checks that all drivers of a population have the same delays of radar and V2V, range of the radar and maximum
// braking. A constant distance is safe only if no vehicle brakes harder than its follower can. Also reports
// late_brake_problems().
void check_fleets(const Scenario& scenario, Checker& check);

// Full dynamics: returns the components whose gaps are too small because their brakes respond later than those of other
// vehicles. In a hard stop, the gap shrinks by the difference of the brake lags times the speed. The check covers
// speeds up to the highest speed limit, which is known only after the import for an imported network.
std::vector<FieldProblem> late_brake_problems(const Scenario& scenario);

// Returns the mean length of the vehicles of a population, m.
double mean_vehicle_m(const Scenario& scenario, const PopulationSettings& population);
// Returns the length of the longest vehicle of all populations, m.
double longest_vehicle_m(const Scenario& scenario);

}  // namespace stopline
