// The receive phase of full dynamics with an active V2V channel (V2vPlan).
#pragma once

#include <span>

#include "sim/state/model.h"
#include "sim/state/partition.h"
#include "sim/state/state.h"
#include "sim/state/vehicles/full_group.h"
#include "sim/state/vehicles/lane_group.h"

namespace stopline {

// Receives the messages of this step. Replaces FullGroup::heard_acceleration, heard_request and heard_rate by the last
// message that has arrived from the leader, extrapolated to the present. Without a recent message, radar replaces the
// message and the desired gap grows (v2v/fallback.h). A vehicle at rest does not start on an old message. Only vehicles
// without human drivers send and receive. Does nothing without an active channel.
void receive_messages(const Model& model, State& state, std::span<const LaneStep> lanes, const FullGroup& group,
                      Partition& part);

// Measures State::vehicles_per_km if the channel reads it. Call in each step; most calls return at once.
void measure_density(const Model& model, State& state);

}  // namespace stopline
