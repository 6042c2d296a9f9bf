// Plans the arrival times and paths of vehicles before the run.
#pragma once

#include <string>

#include "base/input_error.h"
#include "scenario/scenario.h"
#include "sim/state/model.h"

namespace stopline {

// Returns true if each vehicle of this demand has an arrival time of its own. False: no arrival times, or a constant
// headway.
bool plans_arrivals(const Scenario& scenario);

// Adds approaches to a graph that has none, so that vehicles change lanes between adjacent lanes. Lanes of the same
// approach have names that differ only in their last number.
void add_approaches(LaneGraph& graph);

// Returns the names of the legs where vehicles enter the network and where they leave it.
std::vector<std::string> entry_legs(const LaneGraph& graph);
std::vector<std::string> exit_legs(const LaneGraph& graph);

// Thrown if the vehicles of a lane do not fit into the time, because demand.platoon_headway is too long.
class PlatoonsDoNotFit : public InputError {
    using InputError::InputError;
};

// Plans the arrivals of all inlets from the first step until the end of the run. The inlets must exist. Throws
// PlatoonsDoNotFit if platoons do not fit into the time.
void plan_arrivals(const Scenario& scenario, Model& model);

}  // namespace stopline
