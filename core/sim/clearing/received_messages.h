// Cooperative clearing over a V2V channel: the messages of other vehicles that a vehicle has received.
//
// Every V2V message carries the announcement of the sender's lane and the place that the sender has booked. Both
// arrive late or get lost with the message. The vehicles of one lane are close to each other, so no
// loss is assumed between them when they make their joint announcement. Claims are not lost either. They decide
// which vehicle gets a place first. They do not make a place free or taken.
#pragma once

#include "sim/state/clearing_state.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// A vehicle that approaches its stop line and listens to the vehicles on its exit lane and on the other approaches.
struct Listener {
    int lane = -1;  // approach lane
    int slot = -1;
    int exit = -1;           // exit lane
    double to_exit_m = 0.0;  // distance from the vehicle's front to the start of the exit lane
};

// Returns the latest announcement that the lane made before this step; nullptr: none.
const LaneAnnouncement* latest_announcement(const State& state, int lane);

// The newest announcement that a listener has received from its exit lane.
struct ReceivedAnnouncement {
    bool is_fresh = false;                           // the newest message from the exit lane is at most 1 s old
    const LaneAnnouncement* announcement = nullptr;  // nullptr: the vehicles of the lane have announced nothing
};
// Precondition: uses_channel(). A lane without V2V vehicles counts as fresh, because the listener sees it.
ReceivedAnnouncement received_announcement(const Model& model, const State& state, const Listener& listener);

// The bookings on the exit lane by vehicles of other approach lanes.
struct ReceivedBookings {
    bool is_fresh = true;    // the newest message of each vehicle with a booking is at most 1 s old
    double unknown_m = 0.0;  // booked length of which the listener has not received the message
};
// Precondition: uses_channel().
ReceivedBookings received_bookings(const Model& model, const State& state, const Listener& listener);

}  // namespace stopline
