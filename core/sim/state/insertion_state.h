// The data for the insertion of vehicles: inlets, trips that wait for room, and drawn turns. Owner: sim/insertion.
// sim/lane_change/route_choice.cpp draws the turns.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "network/lane_graph.h"

namespace stopline {

// Departure delays: times from arrival to entry. Vehicles of the backlog count with the time since their arrival.
struct DepartureDelays {
    std::int64_t vehicles = 0;
    double sum_s = 0.0;
    double max_s = 0.0;

    // Returns the mean; NaN if there is no vehicle.
    double mean_s() const {
        return vehicles > 0 ? sum_s / static_cast<double>(vehicles) : std::numeric_limits<double>::quiet_NaN();
    }
    void add(double delay_s) {
        ++vehicles;
        sum_s += delay_s;
        max_s = std::max(max_s, delay_s);
    }
    void add(const DepartureDelays& other) {
        vehicles += other.vehicles;
        sum_s += other.sum_s;
        max_s = std::max(max_s, other.max_s);
    }
};

// A lane on which routes begin: an entry lane of the network, or a link lane between two intersections. The vehicles of
// an inlet are numbered from 0, in the order in which they get their route.
struct InletState {
    // Number of vehicles that have got their route from this inlet: vehicles inserted on the lane, and vehicles that
    // come from upstream. A vehicle from upstream is counted as soon as its turn is drawn, even if it is not on the
    // lane yet. A vehicle that still waits for insertion is not counted.
    std::int64_t entered = 0;
    int next_policy = -1;        // spacing policy of the next vehicle; -1: not drawn yet
    int next_route = -1;         // route of the next vehicle
    int next_path = -1;          // path of the next vehicle (DemandPlan::Inlet::paths); -1: none
    double last_entry_s = -1e9;  // time of the most recent insertion on this lane
    // Number of vehicles in DemandPlan::Inlet::arrivals_s that have entered. Vehicles of initial queues are not in this
    // list.
    std::int64_t entered_arrivals = 0;
    DepartureDelays delays;  // only of vehicles that have an arrival time
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
    std::vector<DepartureDelays> trip_delays;     // [approach] delays of trips
    int next_id = 0;                              // id of the next vehicle that enters the network
    std::vector<int> vehicle_trips;               // [vehicle id] its trip; -1: none; empty if trips have no names
};

}  // namespace stopline
