// This file computes what human drivers see of their leaders in full dynamics (driver/human.h).
#pragma once

#include <span>

#include "sim/state/model.h"
#include "sim/state/state.h"
#include "sim/state/vehicles/full_group.h"
#include "sim/state/vehicles/lane_group.h"

namespace stopline {

// Replaces FullGroup::gap and FullGroup::closing of all vehicles with human drivers. The new values are the
// measurements of one reaction time ago, with temporal anticipation and estimation errors. Does nothing if no driver is
// human.
//
// Also limits FullGroup::demand of these vehicles to the braking of emergency_acceleration() and
// keep_room_acceleration() for the present gap (our choice, not in the source of human.h). Without this braking, a
// driver whose reaction time is longer than its time gap could run into a leader that brakes hard.
void see_as_humans(const Model& model, const State& state, std::span<const LaneStep> lanes, const FullGroup& group);

}  // namespace stopline
