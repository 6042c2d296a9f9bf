// This file computes how human drivers react to the vehicles ahead in full dynamics (driver/human.h).
#pragma once

#include <span>

#include "sim/state/model.h"
#include "sim/state/state.h"
#include "sim/state/vehicles/full_group.h"
#include "sim/state/vehicles/lane_group.h"

namespace stopline {

// Sets FullGroup::interaction of all vehicles with human drivers. The values are computed from past measurements, with
// temporal anticipation and estimation errors. The age of the measurements is the reaction time, but at most the time
// since the own start (view_age_s()). Limits FullGroup::demand to 0 for drivers at rest that wait to start. Counts
// VehicleArrays::start_ticks. Does nothing if no driver is human.
//
// Also limits FullGroup::demand of these vehicles to the braking of emergency_acceleration() and
// keep_response_room_acceleration() for the present gap (our choice, not in the source of human.h). Without this
// braking, a driver whose reaction time is longer than its time gap could run into a leader that brakes hard.
void react_as_humans(const Model& model, State& state, std::span<const LaneStep> lanes, const FullGroup& group);

}  // namespace stopline
