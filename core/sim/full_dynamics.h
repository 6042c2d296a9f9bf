// The two kernels of the full-dynamics fidelity, a lane at a time: plan (driver: what acceleration is asked for, from the state at the
// beginning of the step) and drive (vehicle: what the powertrain makes of it, and the new position).
#pragma once

#include <vector>

#include "sim/model.h"
#include "sim/state.h"

namespace stopline {

// What the kernels need of one lane in one step.
struct LaneStep {
    int begin = 0;  // slots [begin, end), whole batches
    int end = 0;
    int first = 0;  // slots [first, stop): vehicles
    int stop = 0;
    double turn_m = 0.0;  // where the limit of the next lane begins to hold, from the lane's start
    double limit_mps = 0.0;
    double sine = 0.0;       // of the slope
    int stop_slot = -1;      // vehicle that stops at the stop line, ...
    double stop_mps2 = 0.0;  // ... and what that asks of it
    int hold_slot = -1;      // vehicle that waits to give way
    double hold_mps2 = 0.0;
    bool leads_to_lower_limit = false;  // some lane that follows has a lower limit
    int to_next_lane = 0;               // slots to those of the lane treated next; 0: all is in the cache
};

// The model's tables as the kernels read them: in single precision.
struct FullTables {
    DriverTablesOf<float> driver;
    std::vector<PowertrainTablesOf<float>> vehicles;  // [type]
};
FullTables full_tables(const Model& model);

void plan_full(const Model& model, const FullTables& tables, const LaneStep& lane, State& state);
void drive_full(const Model& model, const FullTables& tables, const LaneStep& lane, State& state);

}  // namespace stopline
