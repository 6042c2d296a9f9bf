// Constant data of one lane as the phases read them.
#pragma once

#include <array>
#include <cstddef>

#include "network/lane_graph.h"

namespace stopline {

// One cache line. A connection is a lane inside an intersection.
struct alignas(64) LanePlan {
    double length_m = 0.0;
    double stop_line_m = 0.0;
    double next_limit_m = 0.0;  // position from which the speed limit of the next lane applies
    double limit_mps = 0.0;
    double first_conflict_m = 1e9;      // connection: start of its first conflict area
    float sine = 0.0F;                  // sine of the slope angle
    int signal_group = -1;              // -1: no stop line
    int origin = -1;                    // connection: lane that it leaves; -1: not a connection
    int exit = -1;                      // connection: lane that it leads to
    int bitset_index = -1;              // connection that meets others: its number in bitsets
    bool yields = false;                // gives way to another lane
    bool branches = false;              // several lanes follow
    bool has_movement_signals = false;  // approach lane: each movement has its own signal group
    bool keep_clear = true;             // connection: the keep-clear rule applies
};

// How to continue with one turn from a lane.
struct TurnOption {
    int route = -1;        // first route from this lane with the turn; -1: none
    int lane_changes = 0;  // to the nearest lane with such a route; positive to the right, negative to the left
};

// The position of an approach lane among its neighbours.
struct AdjacentLanes {
    int left = -1;
    int right = -1;
    int index = 0;                // on the approach, from the left
    double start_offset_m = 0.0;  // start of the lane, from the start of the longest lane of the approach
    std::array<TurnOption, kMaxTurns> turn_options = {};  // [Turn]

    const TurnOption& turn_option(Turn turn) const { return turn_options[static_cast<std::size_t>(turn)]; }
    bool has_neighbours() const { return left >= 0 || right >= 0; }
};

}  // namespace stopline
