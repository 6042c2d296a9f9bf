// The input of the full-dynamics kernels: a group of lanes whose vehicles are computed together.
#pragma once

#include <cstddef>
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

// A vehicle whose leader has changed, or for which a V2V message is due.
struct DueReceiver {
    int slot = 0;
    int place = 0;  // index of the vehicle in the group
    int lane = 0;   // index in LaneGroup::lanes
};

// A change of the driving mode of a vehicle (v2v/fallback.h).
struct V2vModeStep {
    int slot = 0;
    int place = 0;  // index of the vehicle in the group
    int from_mode = 0;
    int to_mode = 0;
};

// The working memory of the receive phase for one lane group. Each array has one value for each vehicle of the group.
struct ReceiveWork {
    std::vector<DueReceiver> due;
    std::vector<V2vModeStep> mode_changes;
    // Runs with platoons only.
    std::vector<float> mini_leader;    // 1: the vehicle leads a mini-platoon
    std::vector<char> keeps_distance;  // 1: the spacing policy keeps a constant distance at this speed

    void reserve(std::size_t vehicles) {
        if (due.size() >= vehicles) return;
        due.resize(vehicles), mode_changes.resize(vehicles), mini_leader.resize(vehicles);
        keeps_distance.resize(vehicles);
    }
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
