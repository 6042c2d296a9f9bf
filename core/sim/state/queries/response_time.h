// The time that a vehicle needs to respond to the braking of its leader if V2V messages are late or lost.
#pragma once

#include "sim/state/model.h"

namespace stopline {

// Returns the time from the moment at which a leader begins to brake until its follower brakes in the same way, s.
// `policy`: that of the follower.
//
// Safety. Leader and follower drive at the speed v and can both brake with b. If the follower does the same as its
// leader, but a time T later, it comes to rest v T closer to the leader. So a gap of v T plus a margin prevents contact
// whatever the leader does, and whether or not messages arrive. As every follower does the same as its leader, the
// length of the platoon does not matter. With a shorter gap g, each follower would have to brake harder than its
// leader: its 1 / b would have to be lower than that of its leader by up to T^2 / (2 g).
//
// Without messages, T is the delay of the radar, the time to estimate the leader's acceleration, and the lag of the
// brake. The leader's own lag does not count: radar sees its real motion. If the channel loses no message, T is the
// longest age of a message. Brakes with the same lag then add nothing, as a message announces the leader's request. A
// reserve covers one step and gear changes, which weaken the brake for a moment. Gear changes reduce the mean
// deceleration in a stop from 70 km/h from 7 m/s2 to 6.8 m/s2. This costs as much as 0.04 s.
// Precondition: V2vPlan::is_active.
double response_time_s(const Model& model, int policy);

// Returns true if vehicles of the policy keep at least response_gap_m(): full dynamics with an active V2V channel, and
// no human drivers.
inline bool keeps_response_gap(const Model& model, int policy) {
    return model.v2v_plan.is_active && !model.driver_of(policy).is_human;
}

// Returns the shortest net gap with which a vehicle of the policy does not touch a leader of the same speed, m. Same
// precondition.
inline double response_gap_m(const Model& model, int policy, double speed_mps) {
    return model.driver_of(policy).tables.cacc.emergency_gap_m + response_time_s(model, policy) * speed_mps;
}

}  // namespace stopline
