// What the kernels need of lanes in one step.
#pragma once

#include <vector>

namespace stopline {

struct LaneStep {
    int begin = 0;  // slots [begin, stop): vehicles
    int stop = 0;
    double turn_m = 0.0;  // where the limit of the next lane begins to hold, from the lane's start
    double limit_mps = 0.0;
    double sine = 0.0;  // of the slope
    // Mesoscale mode: what a kernel writes beyond the last vehicle must end before this slot.
    int free_until = 0;

    int count() const { return stop - begin; }
};

// What a stop line, giving way, or leading asks of one vehicle.
struct Imposed {
    int place = 0;      // in the group
    double asks = 0.0;  // an acceleration, in the mesoscale mode a speed
};

// Lanes that go through the kernels together, in the order of their slots.
struct LaneGroup {
    std::vector<LaneStep> lanes;
    std::vector<Imposed> imposed;
    int vehicles = 0;
    int lanes_of_network = 0;  // several may be of one lane of the network

    // Vehicles from this slot on must not be written over.
    void protect(int slot) {
        for (auto lane = lanes.rbegin(); lane != lanes.rend() && lane->free_until > slot; ++lane)
            lane->free_until = slot;
    }
    void clear() {
        lanes.clear();
        imposed.clear();
        vehicles = 0;
        lanes_of_network = 0;
    }
};

}  // namespace stopline
