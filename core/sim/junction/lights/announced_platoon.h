// Platoons that announce their arrival to a signal by V2V.
#pragma once

#include <cstdint>

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// The first platoon of the lane that can still stop if green ends now. It begins with the first vehicle that can stop
// before the line. Its vehicles are automated and follow each other closely. A platoon of limited length
// (PlatoonSettings::max_vehicles) ends before the leader of the next mini-platoon.
struct AnnouncedPlatoon {
    std::int64_t rear_tick = -1;  // tick at which its rear passes the line if the light stays green; -1: no platoon
    // The whole platoon can wait for the next green. False: other vehicles of the platoon pass the line, or its first
    // vehicle is stopped in the queue and starts at this green.
    bool can_wait = true;
};

// Returns the platoon of the first vehicle of the lane that can still stop comfortably before the stop line. There is
// none if this vehicle is farther than `range_m` from the line or has a human driver. The rear may be beyond the range,
// but not beyond the lane. In the forecast, each vehicle accelerates at its comfort limit to the speed limit, unless
// its leader and its desired gap hold it up.
AnnouncedPlatoon announced_platoon(const Model& model, const State& state, int lane, double range_m);

}  // namespace stopline
