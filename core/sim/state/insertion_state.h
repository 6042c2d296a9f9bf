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
    // Number of vehicles that have got their route from this inlet: vehicles inserted on the lane, and vehicles that
    // come from upstream. A vehicle from upstream is counted as soon as its turn is drawn, even if it is not on the
    // lane yet. A vehicle that still waits for insertion is not counted.
    std::int64_t entered = 0;
    int next_policy = -1;        // spacing policy of the next vehicle; -1: not drawn yet
    int next_route = -1;         // route of the next vehicle
    double last_entry_s = -1e9;  // time of the most recent insertion on this lane
};

struct InsertionState {
    std::vector<InletState> inlets;
    // Indices of the inlets that insert_vehicles() checks, ascending: all inlets on entry lanes, and those inlets on
    // link lanes that still have vehicles to insert.
    std::vector<int> open_inlets;
    std::vector<int> inlet_of;  // [lane] index of the inlet; -1: no route begins on the lane
    // [approach][Turn] number of vehicles on all lanes of the approach for which the turn was drawn. If these numbers
    // deviate from the planned turn shares of the approach (DemandPlan::Inlet::approach_shares), the next draws correct
    // the deviation. Draws at inlets without such planned shares are not counted.
    std::vector<std::array<std::int64_t, kMaxTurns>> drawn_turns;
    std::size_t next_trip = 0;                    // index of the first trip whose departure time has not come yet
    std::vector<std::vector<int>> waiting_trips;  // [approach] trips whose vehicles wait to be inserted, oldest first
    std::vector<int> approaches_with_backlog;     // approaches with waiting trips, ascending
    int next_id = 0;                              // id of the next vehicle that enters the network
};

}  // namespace stopline
