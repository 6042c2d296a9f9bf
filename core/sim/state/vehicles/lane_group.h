// The input of the full-dynamics kernels: a group of lanes whose vehicles are computed together.
#pragma once

#include <vector>

namespace stopline {

struct LaneStep {
    int begin = 0;  // the vehicles of the lane are in the slots [begin, stop)
    int stop = 0;
    double next_limit_m = 0.0;  // position from which the speed limit of the next lane applies
    double limit_mps = 0.0;
    double sine = 0.0;     // sine of the slope angle
    int intersection = 0;  // intersection to which the lane belongs

    int count() const { return stop - begin; }
};

// The acceleration that one vehicle must not exceed. The reason is a stop line, yielding, a gap alignment, or a vehicle
// that the leader hides (sim/perception/hidden_leaders.h).
struct ExternalDemand {
    int index = 0;  // index of the vehicle in the group
    double acceleration_mps2 = 0.0;
};

struct LaneGroup {
    std::vector<LaneStep> lanes;  // in the order of their slots
    std::vector<ExternalDemand> demands;
    std::vector<int> prefetch_slots;  // one slot in each cache line that holds vehicles of the group
    int vehicles = 0;

    void clear() {
        lanes.clear();
        prefetch_slots.clear();
        demands.clear();
        vehicles = 0;
    }
};

}  // namespace stopline
