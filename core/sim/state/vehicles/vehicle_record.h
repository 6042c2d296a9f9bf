// The data of a vehicle that are read mainly at events.
#pragma once

#include <cstdint>

#include "network/lane_graph.h"

namespace stopline {

// The struct fills one cache line. A connection is a lane inside an intersection.
struct alignas(64) VehicleRecord {
    int route = -1;
    int route_index = 0;                // index of the current lane in the route
    int previous_lane = -1;             // lane before the current one; -1: the vehicle was inserted on the current lane
    int second_previous_lane = -1;      // lane before previous_lane; -1: none
    int leader_id = -1;                 // id of the vehicle that the radar tracks; -1: none
    int accepted_gap_on = -1;           // connection on which the vehicle has accepted a gap; -1: none
    int junction_entry_tick = 0;        // tick at which the vehicle passed its last stop line
    int yield_tick = -2;                // last tick at which the vehicle had to wait before a conflict area
    float yield_position_m = 0.0F;      // where the vehicle had to wait, from the start of the connection
    Turn following_turn = Turn::none;   // turn at the second intersection ahead; none: not known yet
    Turn third_turn = Turn::none;       // turn at the third intersection ahead; none: not known yet, or a trip
    std::int8_t preferred_offset = 0;   // offset to the lane that suits the later turns; below 0: to the left
    bool preferred_for_third = false;   // the preferred lane is for the third turn only, not for the following one
    float remembered_mps = 0.0F;        // highest recent speed, which fades within seconds (lane changes)
    float lane_gain_mps = 0.0F;         // expected gain in speed by a lane change, summed up; above 0: to the left
    int lane_change_tick = -1'000'000;  // tick of the last lane change
    int lane_before_change = -1;        // lane that the vehicle left in the last lane change; -1: none
    int trip = -1;                      // index of the trip in the demand; -1: no trip, the turns are drawn
    int trip_edge = 0;  // index of the present edge in the trip; inside an intersection: of the edge upstream
};

}  // namespace stopline
