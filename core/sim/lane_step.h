// What the kernels need of one lane in one step.
#pragma once

#include <array>

namespace stopline {

struct LaneStep {
    int begin = 0;  // slots [begin, stop): vehicles
    int stop = 0;
    double turn_m = 0.0;  // where the limit of the next lane begins to hold, from the lane's start
    double limit_mps = 0.0;
    double sine = 0.0;  // of the slope
    // Vehicles that stop at the stop line or wait to give way, and what that asks of them.
    struct Imposed {
        int slot = -1;
        double asks = 0.0;  // an acceleration, in the mesoscale mode a speed
    };
    std::array<Imposed, 4> imposed = {};
    int imposed_count = 0;
    double leader_mps = 0.0;  // mesoscale mode: highest speed of a first vehicle without predecessor; 0: it has one

    int count() const { return stop - begin; }
};

}  // namespace stopline
