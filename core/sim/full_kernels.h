// The inner loops of the full-dynamics fidelity, over plain arrays, and the choice among their builds.
#pragma once

#include <cstdint>
#include <span>

#include "driver/acceleration_laws.h"
#include "sim/lane_step.h"
#include "sim/state.h"
#include "vehicle/powertrain_tables.h"

namespace stopline {

// Plain pointers to the arrays of one plan step, so that the compiler sees independent streams.
struct PlanStreams {
    const double *position, *speed, *desired_gap, *slope;
    const float *acceleration, *lag, *length, *standstill_gap, *end_speed;
    float *request, *leads;
    float *gap_now, *closing_now, *tell_acceleration, *tell_request, *tell_rate;
    const float *gap_late, *gap_later, *closing_late, *closing_later;
    const float *heard_acceleration, *heard_request, *heard_rate;
    const float *earlier_acceleration, *earlier_request, *earlier_rate;
};

struct DriveStreams {
    const double* speed;
    float *acceleration, *torque, *brake, *gear_time, *lag, *gear;
    const float *request, *request_before;
    const int* type;
};

// All kernels treat several lanes in one call: most lanes hold few vehicles.
struct FullKernels {
    using Lanes = std::span<const LaneStep>;
    const char* name;
    void (*plan)(const PlanStreams&, const DriverTablesOf<float>&, const Rows& radar, const Rows& v2v, Lanes,
                 double dt);
    // `only`: treats vehicles of this type; < 0: all are of the type given.
    void (*drive)(const DriveStreams&, const PowertrainTablesOf<float>&, Lanes, double dt, int only);
    // Speed and position from the acceleration realised in the step.
    void (*integrate)(double* position, double* speed, const float* acceleration, Lanes, double dt);
    // Fronts that are beyond the rear of their predecessor on the same lane.
    std::int64_t (*overlaps)(const double* position, const float* length, Lanes);
};

// The widest build that this machine runs, or the scalar one: one vehicle at a time, the oracle of the others.
const FullKernels& full_kernels(bool scalar);

}  // namespace stopline
