// Builds the Model of a run from a scenario and one of its populations. A Model does not change during the run.
#pragma once

#include "scenario/scenario.h"
#include "sim/state/model.h"

namespace stopline {

// Builds the model for scenario.populations[population]. Throws InputError if the scenario contradicts
// itself, for instance by the name of an unknown policy.
Model build_model(const Scenario& scenario, std::size_t population);

// Replaces the parameters of the mesoscale mode in a model. A calibration calls this function to try parameters.
void set_meso(const MesoSettings& settings, Model& model);

}  // namespace stopline
