// From a scenario and one of its populations to the constant Model of a run.
#pragma once

#include "scenario/scenario.h"
#include "sim/model.h"

namespace stopline {

// Throws InputError where the scenario's parts do not fit together. `population` is an index into scenario.populations.
Model build_model(const Scenario& scenario, std::size_t population);

// Gives a model of the mesoscale mode other parameters than its scenario has.
void set_meso(const Scenario& scenario, const MesoSettings& settings, Model& model);

}  // namespace stopline
