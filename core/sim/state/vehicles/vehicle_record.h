// The data of a vehicle that are read at events only.
#pragma once

#include "network/lane_graph.h"

namespace stopline {

// One cache line. A connection is a lane inside an intersection.
struct alignas(64) VehicleRecord {
    int route = -1;
    int route_index = 0;                // index of the current lane in the route
    int previous_lane = -1;             // -1: the vehicle entered the network on the current lane
    int second_previous_lane = -1;      // lane before the previous one; -1: none
    int leader_id = -1;                 // vehicle tracked by the radar; -1: none
    int accepted_gap_on = -1;           // connection on which the vehicle has accepted a gap; -1: none
    int junction_entry_tick = 0;        // tick at which the vehicle passed its last stop line
    int yield_tick = -2;                // last tick at which the vehicle had to wait before a conflict area
    float yield_position_m = 0.0F;      // place of that wait, from the start of the connection
    Turn following_turn = Turn::none;   // turn at the next intersection but one; none: not known yet
    int lane_change_tick = -1'000'000;  // tick of the last lane change
    int lane_before_change = -1;
    int trip = -1;      // index of the trip in the demand; -1: the turn is drawn at each intersection
    int trip_edge = 0;  // index, in the trip, of the edge that the vehicle is on or has left last
};

}  // namespace stopline
