// What the kernels need of one lane in one step.
#pragma once

namespace stopline {

struct LaneStep {
    int begin = 0;  // slots [begin, stop): vehicles
    int stop = 0;
    double turn_m = 0.0;  // where the limit of the next lane begins to hold, from the lane's start
    double limit_mps = 0.0;
    double sine = 0.0;       // of the slope
    int stop_slot = -1;      // vehicle that stops at the stop line, ...
    double stop_asks = 0.0;  // ... and what that asks of it: an acceleration, in the mesoscale mode a speed
    int hold_slot = -1;      // vehicle that waits to give way
    double hold_asks = 0.0;
    double leader_mps = 0.0;  // mesoscale mode: highest speed of a first vehicle without predecessor; 0: it has one

    int count() const { return stop - begin; }
};

}  // namespace stopline
