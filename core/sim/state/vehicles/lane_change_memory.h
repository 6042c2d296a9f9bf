// This struct holds what a vehicle remembers for its next lane changes.
#pragma once

#include <cstdint>

#include "network/lane_graph.h"

namespace stopline {

struct LaneChangeMemory {
    int change_tick = -1'000'000;  // tick of the most recent lane change
    // Ticks of the most recent mandatory lane changes of other vehicles to the place directly ahead of this vehicle.
    // Only changes during which this vehicle was almost at rest count.
    int let_in_waiting_tick = -1'000'000;  // of a vehicle that had waited (has_reached_waiting_position())
    int let_in_tick = -1'000'000;          // of any other vehicle
    float remembered_mps = 0.0F;           // highest recent speed; falls gradually while the vehicle drives more slowly
    // Speed that the vehicle would recently have gained on the left or right lane: the gain in acceleration, summed
    // over time. Older gains fade. The vehicle may change when the sum reaches LaneChangeSettings::gain_mps. Below 0:
    // the vehicle has just left that lane.
    float left_gain_mps = 0.0F;
    float right_gain_mps = 0.0F;
    // Number of lanes from the present lane to the preferred lane, which suits the later turns best; below 0: to the
    // left.
    std::int8_t preferred_offset = 0;
    // True: for the turn at the second intersection ahead, the present lane suits as well as the preferred lane. Only
    // the turn at the third intersection is the reason for the preference.
    bool preferred_for_third = false;
};

}  // namespace stopline
