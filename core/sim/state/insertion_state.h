// Inlets, trips and drawn turns. Owner: sim/insertion; sim/lane_change/route_choice.cpp draws the turns.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "network/lane_graph.h"

namespace stopline {

// A lane on which routes begin: an entry of the network, or a lane between two intersections.
struct InletState {
    std::int64_t entered = 0;  // vehicles that got a route here
    int next_policy = -1;      // policy of the next vehicle; -1: not drawn yet
    int next_route = -1;
    double last_entry_s = -1e9;
};

// Vehicles of an inlet are numbered in the order of entry.
struct InsertionState {
    std::vector<InletState> inlets;
    std::vector<int> open_inlets;  // entries, and lanes between intersections that still insert vehicles; ascending
    std::vector<int> inlet_of;     // [lane] -1: no route begins there
    std::vector<std::array<std::int64_t, kMaxTurns>> drawn_turns;  // [approach][Turn] if approach shares are given
    std::size_t next_trip = 0;                                     // first trip that is not due yet
    std::vector<std::vector<int>> waiting_trips;                   // [approach] trips of the backlog, oldest first
    std::vector<int> approaches_with_backlog;                      // ascending
    int next_id = 0;
};

}  // namespace stopline
