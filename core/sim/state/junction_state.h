// The vehicles inside intersections, and the positions where vehicles must yield. Owner: sim/junction. sim/lane_change
// adds yield stops for vehicles that wait for a gap in the adjacent lane.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/containers/bitset.h"
#include "base/simd/huge_page_allocator.h"
#include "sim/state/vehicles/vehicle_record.h"

namespace stopline {

// A vehicle inside an intersection: its front has passed the stop line, and its rear has not reached the exit lane. A
// vehicle that can no longer stop at the line, although its signal is not green, counts as inside too. Positions are
// measured from the start of the connection. They are negative on the approach lane.
struct JunctionOccupant {
    int slot;
    double front_m;
    double rear_m;
    // Tick at which the front passed the stop line. It is the present tick if the front has not passed this line yet,
    // or is past the next stop line already.
    std::int64_t since_tick;
};

// The position where one vehicle must stop, to yield or to wait for a gap in the adjacent lane.
struct YieldStop {
    int slot = -1;
    double position_m = 0.0;  // stop position, from the start of the lane
    int blocker = -1;         // slot of the vehicle that goes first; -1: none
    YieldReason reason = YieldReason::lane_change;
};

// The yield stops of the vehicles on one lane, in the order of slots, that is, from downstream to upstream.
struct YieldStops {
    static constexpr int kCapacity = 6;
    std::array<YieldStop, kCapacity> stops = {};
    int count = 0;

    // Inserts a stop. If the list is full, the stop of the vehicle furthest upstream is dropped.
    void add(const YieldStop& stop);
    // Returns the stop of the vehicle in `slot`, or nullptr if it has none.
    const YieldStop* find(int slot) const {
        for (int k = 0; k < count; ++k) {
            if (stops[static_cast<std::size_t>(k)].slot == slot) return &stops[static_cast<std::size_t>(k)];
        }
        return nullptr;
    }
};

struct JunctionState {
    LargeArray<int> occupants_place;    // [lane] place in Partition::occupants
    LargeArray<int> approaching_place;  // [lane] place in Partition::approaching
    // [lane] index of the lane's yield stops in Partition::yield_stops; -1: the lane has none in this step
    LargeArray<int> yield_stops_index;
    // Sets of connections. In each set, LanePlan::bitset_index is the index of a connection's bit.
    Bitset occupied;                      // connections with occupants
    Bitset with_stopped;                  // connections with an occupant slower than kCrawlingSpeed_mps (1 m/s)
    Bitset to_decide;                     // connections on which right of way must be decided in this step
    std::int64_t next_priority_tick = 0;  // tick at which a signal phase next changes right of way
};

struct Partition;
struct State;

// Adds a yield stop to a lane of the partition, and adds the lane to Partition::lanes_with_yield_stops if it is not
// there yet.
void add_yield_stop(JunctionState& junctions, Partition& part, int lane, const YieldStop& stop);
// Removes all yield stops from the lanes of the partition.
void clear_yield_stops(JunctionState& junctions, Partition& part);
// Returns the occupants of a connection, furthest downstream first.
std::span<const JunctionOccupant> occupants_of(const State& state, int connection);
// Returns the yield stops of a lane. The reference is valid until the next yield stop is added in the lane's partition.
const YieldStops& yield_stops_of(const State& state, int lane);

}  // namespace stopline
