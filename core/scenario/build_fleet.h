// Translates the vehicles and drivers of a population into the Model.
#pragma once

#include <vector>

#include "scenario/scenario.h"
#include "sim/state/model.h"

namespace stopline {

// Adds the spacing policies, vehicle types and drivers of a population to the model. Adds the shares of its components
// to the demand. Throws InputError if a component names an unknown policy.
void add_fleet(const Scenario& scenario, const PopulationSettings& population, Model& model);

// Mesoscale mode: makes the car-following model of each policy. Adds upper bounds of the accelerations if components
// have their own vehicle or driver, or if the vehicle types of SUMO's files apply.
void add_following_models(const Scenario& scenario, const PopulationSettings& population, Model& model);

// Draws the policies of all trips. If the vehicle types of SUMO's files apply, each trip then gets the variant of its
// policy with the parameters of its vehicle type.
void assign_trip_policies(const Scenario& scenario, Model& model);

}  // namespace stopline
