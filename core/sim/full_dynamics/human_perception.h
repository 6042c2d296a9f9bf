// What human drivers see of their leaders in full dynamics (driver/human.h).
#pragma once

#include <span>

#include "sim/state/model.h"
#include "sim/state/state.h"
#include "sim/state/vehicles/full_group.h"
#include "sim/state/vehicles/lane_group.h"

namespace stopline {

// Replaces FullGroup::gap and FullGroup::closing of all vehicles with human drivers. The new values are the
// measurements of a reaction time ago, with temporal anticipation and estimation errors. Does nothing if no driver is
// human.
//
// A driver could run into a leader that brakes hard, because its reaction time may be longer than its time gap. Where a
// collision threatens, the driver brakes without reaction time (our choice): FullGroup::demand also contains the
// braking of emergency_acceleration() and keep_room_acceleration() for the present gap.
void see_as_humans(const Model& model, const State& state, std::span<const LaneStep> lanes, const FullGroup& group);

}  // namespace stopline
