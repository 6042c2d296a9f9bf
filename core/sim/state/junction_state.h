// Occupants of intersections and the places where vehicles yield. Owner: sim/junction; sim/lane_change adds stops of
// vehicles that wait for a gap.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/containers/bitset.h"

namespace stopline {

// A vehicle inside an intersection: its front is past the stop line, its rear not yet on the exit lane. Positions are
// along the connection and negative on the approach.
struct JunctionOccupant {
    int slot;
    double front_m;
    double rear_m;
    std::int64_t since;  // tick at which the vehicle passed the stop line
};

// A place where one vehicle must stop: to yield, or to wait for a gap in the adjacent lane.
struct YieldStop {
    int slot = -1;
    double position_m = 0.0;            // from the start of the lane
    int blocker = -1;                   // slot of the vehicle that it waits for; -1: a gap in the adjacent lane
    bool blocker_has_priority = false;  // false: the blocker is in the conflict area
};

// The yield stops of a lane's first vehicles, in the order of their slots.
struct YieldStops {
    static constexpr int kCapacity = 6;
    std::array<YieldStop, kCapacity> stops = {};
    int count = 0;

    // Inserts a stop. A full list drops the stop of the vehicle furthest upstream.
    void add(const YieldStop& stop);
    // Returns the stop of a vehicle, or nullptr.
    const YieldStop* find(int slot) const {
        for (int k = 0; k < count; ++k) {
            if (stops[static_cast<std::size_t>(k)].slot == slot) return &stops[static_cast<std::size_t>(k)];
        }
        return nullptr;
    }
};

struct JunctionState {
    std::vector<std::vector<JunctionOccupant>> occupants;  // [connection] the furthest downstream first
    std::vector<std::vector<int>> approaching;             // [connection] slots near it on the approach
    std::vector<YieldStops> yield_stops;                   // [lane]
    std::vector<char> has_yield_stops;                     // [lane] 1: yield_stops is not empty
    // Sets of connections, by NetworkPlan's bitset index.
    Bitset occupied;
    Bitset with_stopped;  // at least one occupant crawls or is stopped
    Bitset to_decide;     // right of way must be decided in this step
};

struct Partition;

// Adds a yield stop to a lane.
void add_yield_stop(JunctionState& junctions, Partition& part, int lane, const YieldStop& stop);

}  // namespace stopline
