// The platoons of the mesoscale mode, for runs in which their length is limited (PlatoonSettings::max_vehicles).
#pragma once

#include <cstddef>

#include "base/simd/huge_page_allocator.h"

namespace stopline {

inline constexpr int kNoPlatoon = -1;

// One value for each slot. The arrays are empty if platoons have no limit.
struct PlatoonArrays {
    // Number of vehicles ahead in the platoon. kNoPlatoon: the policy of the vehicle does not form platoons. The
    // sentinel slot holds the place of the leader beyond the lane in the previous step.
    LargeArray<int> place;
    LargeArray<int> leader_id;  // id of the leader when the place was last decided; -1: none
    // Time gap that the leader of a mini-platoon keeps while it drives; 0: the vehicle leads no mini-platoon.
    LargeArray<double> target_time_gap_s;
    // The time gap moves towards its target (update_time_gap() in v2v/fallback.h).
    LargeArray<double> time_gap_s;
    LargeArray<double> time_gap_rate;

    template <class Visit>
    void for_each(Visit visit) {
        visit(place), visit(leader_id), visit(target_time_gap_s), visit(time_gap_s), visit(time_gap_rate);
    }
    // Sets the data of a vehicle that has just entered.
    void reset(int slot) {
        const auto i = static_cast<std::size_t>(slot);
        place[i] = kNoPlatoon;
        leader_id[i] = -1;
        target_time_gap_s[i] = time_gap_s[i] = time_gap_rate[i] = 0.0;
    }
};

}  // namespace stopline
