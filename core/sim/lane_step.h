// What the kernels of full dynamics need of lanes in one step.
#pragma once

#include <vector>

namespace stopline {

struct LaneStep {
    int begin = 0;  // slots [begin, stop): vehicles
    int stop = 0;
    double turn_m = 0.0;  // where the limit of the next lane begins to hold, from the lane's start
    double limit_mps = 0.0;
    double sine = 0.0;  // of the slope

    int count() const { return stop - begin; }
};

// What a stop line or giving way asks of one vehicle.
struct Imposed {
    int place = 0;  // in the group
    double asks_mps2 = 0.0;
};

// Lanes that go through the kernels together, in the order of their slots.
struct LaneGroup {
    std::vector<LaneStep> lanes;
    std::vector<Imposed> imposed;
    std::vector<int> lines;  // slots of its vehicles, one in each line of the cache
    int vehicles = 0;

    void clear() {
        lanes.clear();
        lines.clear();
        imposed.clear();
        vehicles = 0;
    }
};

}  // namespace stopline
