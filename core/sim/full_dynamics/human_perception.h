// What human drivers see of their leaders in full dynamics (driver/human.h).
#pragma once

#include <span>

#include "sim/state/model.h"
#include "sim/state/state.h"
#include "sim/state/vehicles/full_group.h"
#include "sim/state/vehicles/lane_group.h"

namespace stopline {

// Replaces FullGroup::gap and FullGroup::closing of all vehicles with human drivers. The new values are the measurements
// of a reaction time ago, with temporal anticipation and estimation errors. Does nothing if no driver is human.
void see_as_humans(const Model& model, const State& state, std::span<const LaneStep> lanes, const FullGroup& group);

}  // namespace stopline
