// The state of all vehicles as structures of arrays in lane order. A lane owns a block of slots; its vehicles stand in
// consecutive slots, the first one downstream, so that the predecessor of slot i is slot i - 1. The slot before the first
// vehicle is the lane's sentinel: it holds what the first vehicle must react to beyond the lane (see look_beyond.cpp).
//
//     block of a lane:  | sentinel | free ... | first | ... | last | free ... |
//
// Vehicles leave at the front and enter at the back; how blocks make room for them: lane_blocks.cpp.
#pragma once

#include <cstdint>

#include "base/huge_page_allocator.h"
#include "base/simd.h"
#include "network/lane_graph.h"
#include "vehicle/powertrain_tables.h"

namespace stopline {

struct LaneBlock {
    int begin = 0;  // first slot that a vehicle may take, 1 or more; full dynamics: a multiple of kSimdWidth
    int end = 0;    // one past the last
    int first = 0;  // slot of the vehicle furthest downstream
    int count = 0;  // vehicles

    int last() const { return first + count - 1; }
    int stop() const { return first + count; }
    bool has(int slot) const { return slot >= first && slot < stop(); }
};

// What one vehicle is about, in one line of the cache.
struct alignas(64) VehicleRecord {
    int route = -1;
    int route_index = 0;           // place in the route of the lane the vehicle is on
    int came_from = -1;            // lane before; -1: it entered here
    int came_by = -1;              // the one before that
    int predecessor = -1;          // id of the vehicle that the radar tracks; -1: none
    int cleared_for = -1;          // lane inside an intersection on which it has accepted a gap; -1: none
    int inside_since = 0;          // tick at which it passed its last stop line
    int held_at = -2;              // last tick at which it had to wait before a conflict area
    float held_m = 0.0F;           // where, along the lane inside
    Turn turn_after = Turn::none;  // at the next intersection but one, if known
    int changed_at = -1'000'000;   // tick of its last change of lanes
    int changed_from = -1;         // which lane it left then
    int trip = -1;                 // of the demand; -1: it draws its way at each intersection
    int leg = 0;                   // place in the trip of the edge that it is on, or that it has left last
};

inline constexpr double kAnySpeed_mps = 1e9;
inline constexpr float kNoLowerLimit_mps = 1e3F;  // end_speed_mps where the next lane's limit is no lower

struct VehicleArrays {
    // Read and written every step. One value a slot, SI units.
    LargeArray<double> position_m;  // front, from the lane's start
    LargeArray<double> speed_mps;
    LargeArray<float> acceleration_mps2;  // realised in the last step
    LargeArray<float> length_m;
    LargeArray<float> end_speed_mps;  // limit at the end of the lane, for the route
    LargeArray<float> leads;          // 1: free start-up profile (leader of a platoon), 0: follower
    LargeArray<int> policy;
    LargeArray<int> id;  // mesoscale mode: -1 where there is no vehicle
    // Mesoscale mode only, empty in full dynamics: what the lane asks of the vehicle. It stays when the vehicle goes to another lane.
    LargeArray<double> limit_mps;  // highest speed on it
    LargeArray<double> turn_m;     // where end_speed_mps begins to hold, from its start
    LargeArray<double>
        imposed_mps;  // highest speed of this step, for a stop line, giving way, or leading; else kAnySpeed_mps
    // Full dynamics only, empty in the mesoscale mode.
    LargeArray<float> request_mps2;  // u: the acceleration asked for in the last step
    LargeArray<float> torque_Nm;
    LargeArray<float> brake_N;
    LargeArray<float> gear_time_s;
    LargeArray<float> lag_s;  // tau, as told to the follower
    LargeArray<float> gear;   // 0 is first gear
    // Slots of the past, [row][slot]: radar (gap, closing speed) and V2V (acceleration, request, 1 / lag).
    LargeArray<float> radar_gap_m;
    LargeArray<float> radar_closing_mps;
    LargeArray<float> v2v_acceleration_mps2;
    LargeArray<float> v2v_request_mps2;
    LargeArray<float> v2v_rate_1ps;
    // Read near a lane's head and at events.
    LargeArray<int> next_lane;  // on the route; -1: it leaves, or must change to a lane that leads there
    LargeArray<VehicleRecord> record;
    LargeArray<int> stands_since;  // tick at which it was last seen to move
    LargeArray<float> standstill_gap_m;
    LargeArray<int> type;

    int slots = 0;
    int radar_rows = 0;  // 0, like the other: mesoscale mode
    int v2v_rows = 0;

    // Full dynamics.
    void resize(int slot_count, int radar_row_count, int v2v_row_count);
    // Mesoscale mode: memory for so many slots, not used yet; slots behind those that there are.
    void reserve(int slot_count);
    void grow(int slot_count);
    bool has_powertrain() const { return v2v_rows > 0; }
    // Copies all of one vehicle to a slot of another lane.
    void copy(int from, int to);
    // Moves vehicles in consecutive slots to others of the same lane.
    void move(int from, int count, int to);
    // Where there is no vehicle any more, nothing shall be worked out for one (meso_kernels.inl).
    void forget(int slot) {
        const auto i = static_cast<std::size_t>(slot);
        id[i] = -1;
        leads[i] = 0.0F;
        end_speed_mps[i] = kNoLowerLimit_mps;
    }
    // As a vehicle that has driven like this for long.
    void reset_powertrain(int slot, const PowertrainTables& vehicle, double speed);
    // Fills the past of a vehicle: radar with one measurement, V2V with its present state.
    void reset_radar(int slot, double gap_m, double closing_mps);
    void reset_v2v(int slot);

    std::size_t row(int row_index, int slot) const {
        return static_cast<std::size_t>(row_index) * static_cast<std::size_t>(slots) + static_cast<std::size_t>(slot);
    }

private:
    template <class Visit>
    void for_each_common(Visit visit);
    template <class Visit>
    void for_each_powertrain(Visit visit);
    template <class Visit>
    void for_each_of_lane(Visit visit);
};

}  // namespace stopline
