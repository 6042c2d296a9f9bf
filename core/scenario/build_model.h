// Builds the constant Model of a run from a scenario and one of its populations.
#pragma once

#include "scenario/scenario.h"
#include "sim/state/model.h"

namespace stopline {

// `population` is an index into scenario.populations. Throws InputError if parts of the scenario do not fit together.
Model build_model(const Scenario& scenario, std::size_t population);

// Replaces the parameters of the mesoscale mode in a model, for instance during a calibration.
void set_meso(const Scenario& scenario, const MesoSettings& settings, Model& model);

}  // namespace stopline
