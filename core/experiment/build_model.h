// From a scenario and one of its populations to the constant Model of a run.
#pragma once

#include "scenario/scenario.h"
#include "sim/model.h"

namespace stopline {

// Throws InputError where the scenario's parts do not fit together. `population` is an index into scenario.populations.
Model build_model(const Scenario& scenario, std::size_t population);

}  // namespace stopline
