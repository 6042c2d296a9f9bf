// The inner loops of the full-dynamics fidelity, over plain arrays, and the choice among their builds.
#pragma once

#include <cstddef>

#include "driver/acceleration_laws.h"
#include "sim/full_dynamics.h"
#include "vehicle/powertrain_tables.h"

namespace stopline {

// Plain pointers to the arrays of one plan step, so that the compiler sees independent streams.
struct PlanStreams {
    const double *position, *speed, *acceleration, *lag, *length, *desired_gap, *slope;
    const float *standstill_gap, *end_speed;
    double *request, *leads;
    float *gap_now, *closing_now, *tell_acceleration, *tell_request, *tell_rate;
    const float *gap_late, *gap_later, *closing_late, *closing_later;
    const float *heard_acceleration, *heard_request, *heard_rate;
    const float *earlier_acceleration, *earlier_request, *earlier_rate;
};

struct DriveStreams {
    double *position, *speed, *acceleration, *torque, *brake, *gear_time, *lag, *gear;
    const double* request;
    const float* request_before;
    const int* type;
};

struct FullKernels {
    const char* name;
    void (*plan)(const PlanStreams&, const DriverTables&, const Rows& radar, const Rows& v2v, const LaneStep&,
                 double dt);
    // `only`: treats vehicles of this type; < 0: all are of the type given.
    void (*drive)(const DriveStreams&, const PowertrainTables&, double grade_N, const LaneStep&, double dt, int only);
};

// The widest build that this machine runs, or the scalar one: one vehicle at a time, the oracle of the others.
const FullKernels& full_kernels(bool scalar);

}  // namespace stopline
