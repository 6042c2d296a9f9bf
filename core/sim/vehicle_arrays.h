// The state of all vehicles as structures of arrays in lane order. A lane owns a block of slots; its vehicles stand in
// consecutive slots, the first one downstream, so that the predecessor of slot i is slot i - 1. The slot before the first
// vehicle is the lane's sentinel: it holds what the first vehicle must react to beyond the lane (see lane_heads.cpp).
//
//     block of a lane:  | pad ... | sentinel | first | ... | last | free ... |
//
// Vehicles leave at the front and enter at the back; those that stay move up to the block's start at once or, where they are many,
// when the back reaches its end. Slots that hold no vehicle are computed along with the others and never read.
#pragma once

#include <cstdint>

#include "base/huge_page_allocator.h"
#include "base/simd.h"

namespace stopline {

struct LaneBlock {
    int begin = 0;  // first slot that a vehicle may take; a multiple of kSimdWidth, at least kSimdWidth
    int end = 0;    // one past the last
    int first = 0;  // slot of the vehicle furthest downstream
    int count = 0;  // vehicles

    int last() const { return first + count - 1; }
    int stop() const { return first + count; }
};

struct VehicleArrays {
    // Hot: read and written every step. One value a slot, SI units.
    LargeArray<double> position_m;  // front, from the lane's start
    LargeArray<double> speed_mps;
    LargeArray<float> acceleration_mps2;  // realised in the last step
    LargeArray<float> request_mps2;       // u: the acceleration asked for in the last step
    LargeArray<float> torque_Nm;
    LargeArray<float> brake_N;
    LargeArray<float> gear_time_s;
    LargeArray<float> lag_s;  // tau, as told to the follower
    LargeArray<float> length_m;
    LargeArray<float> gear;   // 0 is first gear
    LargeArray<float> leads;  // 1: free start-up profile (leader of a platoon), 0: follower
    // Slots of the past, [row][slot]: radar (gap, closing speed) and V2V (acceleration, request, 1 / lag).
    LargeArray<float> radar_gap_m;
    LargeArray<float> radar_closing_mps;
    LargeArray<float> v2v_acceleration_mps2;
    LargeArray<float> v2v_request_mps2;
    LargeArray<float> v2v_rate_1ps;
    // Cold: read at events only, or by one kernel.
    LargeArray<float> standstill_gap_m;
    LargeArray<float> end_speed_mps;  // limit at the end of the lane, for the route
    LargeArray<int> policy;
    LargeArray<int> type;
    LargeArray<int> id;
    LargeArray<int> predecessor;  // id of the vehicle that the radar tracks; -1: none
    LargeArray<int> route;
    LargeArray<int> cleared_for;   // lane inside an intersection on which it has accepted a gap; -1: none
    LargeArray<int> inside_since;  // tick at which it passed its last stop line
    LargeArray<int> held_at;       // last tick at which it had to wait before a conflict area
    LargeArray<int> route_index;   // place in the route of the lane the vehicle is on
    LargeArray<int> next_lane;     // on the route; -1: it leaves
    LargeArray<int> came_from;     // lane before; -1: it entered here
    LargeArray<int> stands_since;  // tick at which it was last seen to move

    int slots = 0;
    int radar_rows = 0;
    int v2v_rows = 0;

    void resize(int slot_count, int radar_row_count, int v2v_row_count);
    // Copies all of one vehicle to another slot.
    void copy(int from, int to);
    // Moves vehicles in consecutive slots to slots before theirs.
    void move(int from, int count, int to);
    // Fills the past of a vehicle: radar with one measurement, V2V with its present state.
    void reset_radar(int slot, double gap_m, double closing_mps);
    void reset_v2v(int slot);

    std::size_t row(int row_index, int slot) const {
        return static_cast<std::size_t>(row_index) * static_cast<std::size_t>(slots) + static_cast<std::size_t>(slot);
    }

private:
    template <class Visit>
    void for_each_array(Visit visit);
};

}  // namespace stopline
