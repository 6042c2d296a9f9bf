// The data for the insertion of vehicles: inlets, trips that wait for room, and drawn turns. Owner: sim/insertion.
// sim/lane_change/route_choice.cpp draws the turns.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "network/lane_graph.h"

namespace stopline {

// A lane on which routes begin: an entry lane of the network, or a link lane between two intersections. The vehicles of
// an inlet are numbered from 0, in the order in which they get their route.
struct InletState {
    std::int64_t entered = 0;    // vehicles that have got their route here
    int next_policy = -1;        // spacing policy of the next vehicle; -1: not drawn yet
    int next_route = -1;         // route of the next vehicle
    double last_entry_s = -1e9;  // time of the last insertion on this lane
};

struct InsertionState {
    std::vector<InletState> inlets;
    std::vector<int> open_inlets;  // inlets on entry lanes, and on link lanes that still insert vehicles; ascending
    std::vector<int> inlet_of;     // [lane] index of the inlet; -1: no route begins on the lane
    std::vector<std::array<std::int64_t, kMaxTurns>>
        drawn_turns;                              // [approach][Turn] number of draws at inlets with approach_shares
    std::size_t next_trip = 0;                    // index of the first trip that is not due yet
    std::vector<std::vector<int>> waiting_trips;  // [approach] due trips that have found no room yet, oldest first
    std::vector<int> approaches_with_backlog;     // approaches with waiting trips, ascending
    int next_id = 0;                              // id of the next vehicle
};

}  // namespace stopline
