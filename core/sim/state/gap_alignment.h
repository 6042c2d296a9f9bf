// Speeds that lane changing asks for. Owner: sim/lane_change/gap_search.cpp.
#pragma once

namespace stopline {

// A vehicle that adapts its speed to a gap in the adjacent lane, or opens a gap for a vehicle there.
struct GapAlignment {
    int slot = -1;
    double target_speed_mps = 0.0;

    static constexpr double kDeceleration_mps2 = 1.0;  // gentle braking towards the target speed
};

}  // namespace stopline
