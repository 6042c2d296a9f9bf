// The departure delay of a vehicle with a planned departure, as SUMO counts it.
#pragma once

#include <cstdint>

#include "sim/state/model.h"

namespace stopline {

// Returns the time from the planned departure of a trip to the insertion of its vehicle, in whole steps, s. Even a
// vehicle without delay appears only at the end of the step in which it departs. So the delay counts from that end.
// `trip`: index in DemandPlan::trips, or -1 without a planned departure: the delay is then 0.
// `entry_tick`: the first tick at which the vehicle is in the network.
double departure_delay_s(const Model& model, int trip, std::int64_t entry_tick);

}  // namespace stopline
