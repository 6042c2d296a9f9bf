// The data of a vehicle that are needed only now and then, for example when the vehicle reaches an intersection.
#pragma once

#include <cstdint>

#include "network/lane_graph.h"

namespace stopline {

// The reason for a yield stop (YieldStop in junction_state.h): a position where a vehicle must stop to yield to another
// vehicle, at a stop sign, or to wait for a gap in the adjacent lane.
enum class YieldReason : std::uint8_t {
    priority,     // a vehicle with priority arrives too soon, or another vehicle has stopped earlier at an all-way stop
    occupied,     // another vehicle is in the conflict area or enters it
    intruder,     // another vehicle that must itself yield goes first, for example because it can no longer stop
    merging,      // the vehicle follows another vehicle that merges ahead of it or is about to leave the conflict area
    stop_sign,    // every vehicle must stop at the stop line
    lane_change,  // the vehicle waits for a gap in the adjacent lane
    deadlock,     // driving on would close a cycle of vehicles that block each other
};

// The later route of a vehicle, where the demand gives it. Without trips and paths, a vehicle draws its turns.
struct Itinerary {
    int trip = -1;      // index of the trip in the demand; -1: no trip
    int trip_edge = 0;  // index of the present edge in the trip; inside an intersection: index of the edge upstream
    // Index in DemandPlan::path_routes of the route that the vehicle takes after the present one. -1: that route is
    // drawn, or given by a trip.
    int path = -1;

    bool has_trip() const { return trip >= 0; }
};

// A value of VehicleRecord::yield_tick: the vehicle has not had to wait. It is earlier than the step before the first
// one.
inline constexpr int kNeverYielded_tick = -2;

// A connection is a lane inside an intersection.
struct VehicleRecord {
    int route = -1;
    int route_index = 0;            // index of the current lane in the route
    int previous_lane = -1;         // lane before the current one; -1: the vehicle was inserted on the current lane
    int second_previous_lane = -1;  // lane before previous_lane; -1: none
    int leader_id = -1;             // id of the vehicle that the radar tracks; -1: none
    int accepted_gap_on = -1;       // connection on which the vehicle has accepted a gap; -1: none
    int junction_entry_tick = 0;    // tick at which the vehicle most recently passed a stop line
    // Latest tick at which the vehicle had to wait before a conflict area or at a stop sign.
    int yield_tick = kNeverYielded_tick;
    float yield_position_m = 0.0F;     // position of the wait at yield_tick, from the start of the connection
    Turn following_turn = Turn::none;  // turn at the second intersection ahead; none: unknown or no turn
    Turn third_turn = Turn::none;      // turn at the third intersection ahead; none: not known, or vehicle on a trip
    YieldReason yield_reason = YieldReason::priority;  // reason of the wait at yield_tick
    int wait_since_tick = 0;                           // tick at which the wait at yield_tick began
    int line_stop_tick = -1;  // tick at which the vehicle stopped at the stop line ahead for a stop sign; -1: not yet
};
static_assert(sizeof(VehicleRecord) == 48);  // more bytes would slow down large networks

}  // namespace stopline
