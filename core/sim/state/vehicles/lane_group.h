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

// The acceleration that one vehicle must not exceed. The reason is a stop line, yielding, a speed target, or a vehicle
// that the leader hides (sim/perception/hidden_leaders.h).
struct ExternalDemand {
    int index = 0;  // index of the vehicle in the group
    double acceleration_mps2 = 0.0;
};

// The working memory of the receive phase for one lane group.
struct ReceiveWork {
    // The slots of the vehicles that the receive phase must treat in this step: those that have another leader, for
    // which a message is due, or whose driving mode can change. Ascending.
    std::vector<int> due;
    std::vector<int> due_end;  // [lane of the group] index in `due` after the last vehicle of the lane
    // The slots of the vehicles that send a message in this step.
    std::vector<int> senders;
    std::vector<int> senders_end;
    // Runs with platoons only. One value for each vehicle of the group.
    std::vector<float> mini_leader;    // 1: the vehicle leads a mini-platoon
    std::vector<char> keeps_distance;  // 1: the spacing policy keeps a constant distance at this speed

    void reserve(std::size_t vehicles) {
        if (due.size() >= vehicles) return;
        due.resize(vehicles), due_end.resize(vehicles), senders.resize(vehicles), senders_end.resize(vehicles);
        mini_leader.resize(vehicles), keeps_distance.resize(vehicles);
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
