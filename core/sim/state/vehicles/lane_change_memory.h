// This struct holds what a vehicle remembers for its next lane changes.
#pragma once

#include <cstdint>

#include "network/lane_graph.h"

namespace stopline {

struct LaneChangeMemory {
    int change_tick = -1'000'000;  // tick of the most recent lane change
    float remembered_mps = 0.0F;   // highest recent speed, which fades within seconds
    // Speed that changes to the left and to the right lane would have gained up to now (LaneChangeSettings::gain_mps).
    float left_gain_mps = 0.0F;
    float right_gain_mps = 0.0F;
    Turn third_turn = Turn::none;      // turn at the third intersection ahead; none: not known yet, or a trip
    std::int8_t preferred_offset = 0;  // offset to the lane that suits the later turns best; below 0: to the left
    bool preferred_for_third = false;  // the preferred lane is for the third turn only, not for the following one
};

}  // namespace stopline
