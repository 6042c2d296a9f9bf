// The receive phase of full dynamics with an active V2V channel (V2vPlan).
#pragma once

#include <span>
#include <vector>

#include "sim/full_dynamics/full_kernels.h"
#include "sim/state/model.h"
#include "sim/state/partition.h"
#include "sim/state/state.h"
#include "sim/state/vehicles/full_group.h"
#include "sim/state/vehicles/lane_group.h"

namespace stopline {

// Receives the messages of this step. Replaces FullGroup::heard_acceleration, heard_request and heard_rate by the last
// message that has arrived from the leader, extrapolated to the present. Without a recent message, radar replaces the
// message and the desired gap grows (v2v/fallback.h). A vehicle at rest does not start on an old message. Only vehicles
// without human drivers send and receive. `next`: LaneGroup::prefetch_slots of the next group. Precondition: an active
// channel (VehicleArrays::has_v2v_channel).
void receive_messages(const Model& model, const FullKernels& kernels, std::span<const ReceivePolicy> policies,
                      const LaneGroup& lanes, std::span<const int> next, const FullGroup& group, State& state,
                      Partition& part);

// Stores the messages of the senders of this step. receive_messages() has listed these vehicles. Call after the motion
// of the vehicles. Same precondition.
void send_messages(const Model& model, std::span<const LaneStep> lanes, const FullGroup& group, State& state,
                   const Partition& part);

// Returns the values that the vehicles of each policy share in the receive phase. Same precondition.
std::vector<ReceivePolicy> receive_policies(const Model& model);

// Measures State::vehicles_per_km if the channel reads it. Call in each step; most calls return at once.
void measure_density(const Model& model, State& state);

}  // namespace stopline
