// The constant data of one lane that the phases of a step read.
#pragma once

#include <array>
#include <cstddef>

#include "network/lane_graph.h"

namespace stopline {

// The struct fills one cache line. A connection is a lane inside an intersection.
struct alignas(64) LanePlan {
    double length_m = 0.0;
    double stop_line_m = 0.0;
    double next_limit_m = 0.0;  // position from which the speed limit of the next lane applies
    double limit_mps = 0.0;
    double first_conflict_m = 1e9;      // connection: start of its first conflict area
    float sine = 0.0F;                  // sine of the slope angle
    int signal_group = -1;              // signal group of the stop line; -1: no stop line
    int origin = -1;                    // connection: its approach lane; -1: not a connection
    int exit = -1;                      // connection: its exit lane
    int bitset_index = -1;              // connection: index of its bit in the bitsets of JunctionState; -1: none
    bool yields = false;                // connection: must yield in some conflict area, always or in some signal phase
    bool branches = false;              // true: more than one lane follows
    bool has_movement_signals = false;  // approach lane: movements have signal groups of their own
    bool keep_clear = true;             // connection: the keep-clear rule applies
};

// How a vehicle on a lane can make a certain turn. Either a route with this turn begins on the lane, or the vehicle
// must first change to another lane of the approach where such a route begins.
struct TurnOption {
    int route = -1;  // one of the routes with this turn that begin on this lane; -1: none
    // If `route` is -1: number of lane changes to the nearest lane where such a route begins; below 0: to the left; 0:
    // there is no such lane.
    int lane_changes = 0;
};

// The adjacent lanes of an approach lane, and how a vehicle on this lane can make each turn.
struct AdjacentLanes {
    int left = -1;  // adjacent lane; -1: none
    int right = -1;
    int index = 0;                // index of the lane on the approach, counted from the left
    double start_offset_m = 0.0;  // start of the lane, measured from the start of the longest lane of the approach
    std::array<TurnOption, kMaxTurns> turn_options = {};  // [Turn] how a vehicle on this lane can make the turn

    const TurnOption& turn_option(Turn turn) const { return turn_options[static_cast<std::size_t>(turn)]; }
    bool has_neighbours() const { return left >= 0 || right >= 0; }
};

}  // namespace stopline
