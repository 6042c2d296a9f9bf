// The state of all vehicles, with one array for each quantity. The vehicles of each lane are in consecutive slots.
//
//     block of a lane:  | free ... | sentinel | first | ... | last | free ... |
//
// The leader of the vehicle in slot i is in slot i - 1. The slot before the first vehicle of a lane is the sentinel. It
// holds a copy of the leader downstream of the lane (sim/perception/look_ahead.h). Vehicles leave at the front of the
// block and enter at its back.
#pragma once

#include <cstddef>

#include "base/simd/huge_page_allocator.h"
#include "base/simd/simd.h"
#include "sim/state/vehicles/lane_block.h"
#include "sim/state/vehicles/lane_change_memory.h"
#include "sim/state/vehicles/platoon_arrays.h"
#include "sim/state/vehicles/vehicle_record.h"
#include "v2v/receiver.h"
#include "vehicle/powertrain_tables.h"

namespace stopline {

inline constexpr double kUnlimitedSpeed_mps = 1e9;
inline constexpr float kNoLowerLimit_mps = 1e3F;  // value of end_speed_mps if the next lane has no lower speed limit

struct VehicleArrays {
    // Every step reads these values and changes many of them. Each array has one value for each slot, in SI units.
    LargeArray<double> position_m;  // position of the front, from the start of the lane
    LargeArray<double> speed_mps;
    LargeArray<float> acceleration_mps2;  // acceleration realised in the previous step
    LargeArray<float> length_m;
    LargeArray<float> end_speed_mps;      // entry speed of the next lane of the route, if lower than the present limit
    LargeArray<float> is_platoon_leader;  // 1: platoon leader; 0: follower
    LargeArray<int> policy;
    LargeArray<int> id;  // vehicle id; mesoscale mode: -1 in a free slot
    // Mesoscale mode only. These values depend on the lane. When a vehicle goes to another lane, these values are not
    // copied but set for the new lane.
    LargeArray<double> limit_mps;     // speed limit of the lane times the speed factor
    LargeArray<double> next_limit_m;  // position from which end_speed_mps applies
    // Upper bound of the speed in this step, for a vehicle that stops at a line or a yield stop, aligns with a gap, or
    // drives without a leader. kUnlimitedSpeed_mps: none.
    LargeArray<double> speed_cap_mps;
    // Full dynamics only.
    LargeArray<float> request_mps2;  // acceleration requested in the previous step; u in driver/acceleration_laws.h
    LargeArray<float> torque_Nm;
    LargeArray<float> brake_N;
    LargeArray<float> gear_time_s;
    LargeArray<float> lag_s;  // lag of the powertrain; tau in driver/acceleration_laws.h. Sent to the follower by V2V
    LargeArray<float> gear;   // index of the gear; 0: first gear
    // Delay lines, indexed [row][slot]. They hold radar measurements and V2V messages of past steps.
    LargeArray<float> radar_gap_m;
    LargeArray<float> radar_closing_mps;
    LargeArray<float> v2v_acceleration_mps2;
    LargeArray<float> v2v_request_mps2;
    LargeArray<float> v2v_rate_1ps;   // 1 / lag_s
    LargeArray<float> own_speed_mps;  // at the time of the radar measurement; see stores_own_speed()
    // A step reads these values only for some vehicles, mainly for the first vehicles of a lane and for vehicles that
    // change the lane or the route. Full dynamics also reads the standstill gap of all vehicles, and their type if the
    // model has several types.
    // next_lane: next lane of the route. -1: the vehicle leaves the network from its present lane, or must change lanes
    // because the present lane does not allow its turn.
    LargeArray<int> next_lane;
    LargeArray<VehicleRecord> record;
    LargeArray<int> stopped_since_tick;  // latest tick at which the vehicle was observed in motion
    LargeArray<float> standstill_gap_m;
    // Models with several vehicle types only; see type_of().
    LargeArray<int> type;
    // Demand with trips or paths only; see itinerary_of().
    LargeArray<Itinerary> itinerary;
    // Networks with adjacent lanes only.
    LargeArray<LaneChangeMemory> lane_memory;
    // Runs with human drivers only: number of steps since the vehicle ahead began to move (driver/human.h).
    LargeArray<int> start_ticks;
    // Runs with an active V2V channel only (V2vPlan): the messages that the vehicle has received.
    V2vReceivers v2v;
    // Mesoscale mode with a limited length of platoons only.
    PlatoonArrays platoon;

    int slots = 0;
    int radar_rows = 0;  // 0 in the mesoscale mode
    int v2v_rows = 0;    // 0 in the mesoscale mode
    bool has_several_types = false;
    bool has_itineraries = false;
    bool has_lane_changes = false;
    bool has_human_drivers = false;
    bool has_v2v_channel = false;
    bool has_platoon_limit = false;

    // Full dynamics: sets the number of slots and of rows, and resets all values.
    void resize(int slot_count, int radar_row_count, int v2v_row_count);
    // Mesoscale mode: reserves memory without adding slots.
    void reserve(int slot_count);
    // Mesoscale mode: adds free slots at the end.
    void grow(int slot_count);
    bool has_powertrain() const { return v2v_rows > 0; }
    Itinerary itinerary_of(std::size_t slot) const { return has_itineraries ? itinerary[slot] : Itinerary(); }
    // Returns the index of the vehicle's type in Model::vehicles.
    int type_of(std::size_t slot) const { return has_several_types ? type[slot] : 0; }
    // Copies a vehicle to a slot of another lane, without the values that depend on the lane.
    void copy(int from, int to);
    // Moves vehicles in consecutive slots to other slots of the same lane.
    void move(int from, int count, int to);
    // Marks a slot as free, so that the mesoscale kernels skip it.
    void clear_slot(int slot) {
        const auto i = static_cast<std::size_t>(slot);
        id[i] = -1;
        is_platoon_leader[i] = 0.0F;
        end_speed_mps[i] = kNoLowerLimit_mps;
    }
    // Sets the powertrain to the state of steady driving at a speed.
    void reset_powertrain(int slot, const PowertrainTables& vehicle, double speed);
    // Fills all rows of the radar delay line with one measurement at the present own speed.
    void reset_radar(int slot, double gap_m, double closing_mps);
    // Fills all rows of the V2V delay line with the present state of the vehicle.
    void reset_v2v(int slot);

    // Human drivers and vehicles that estimate their leader's speed need their own speed at the time of a measurement.
    bool stores_own_speed() const { return (has_human_drivers || has_v2v_channel) && radar_rows > 0; }

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
