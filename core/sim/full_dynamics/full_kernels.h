// Inner loops of full dynamics over plain arrays, and the choice among their builds for different instruction sets.
#pragma once

#include <span>

#include "driver/acceleration_laws.h"
#include "sim/state/state.h"
#include "sim/state/vehicles/full_group.h"
#include "vehicle/powertrain_tables.h"

namespace stopline {

// Plain pointers to the arrays of all vehicles, indexed by slot. SI units.
struct FullStreams {
    double *position, *speed;
    const float *length, *standstill_gap, *end_speed;
    const int *policy, *type;  // null if the model has only one
    float *acceleration, *lag, *request, *is_platoon_leader, *torque, *brake, *gear_time, *gear;
    // Rows of the delay lines in this step (DelayRows).
    float *gap_now, *closing_now, *sent_acceleration, *sent_request, *sent_rate;
    const float *gap_delayed, *gap_older, *closing_delayed, *closing_older;
    const float *heard_acceleration, *heard_request, *heard_rate;
    const float *heard_acceleration_older, *heard_request_older, *heard_rate_older;
};

// The kernels of one step, to be called in this order for each lane group.
struct FullKernels {
    using Lanes = std::span<const LaneStep>;
    // One slot for each cache line of the next group, to prefetch; empty: no prefetch.
    using NextSlots = std::span<const int>;

    const char* name;
    // Fills the group: measures by radar, reads the delayed leader data and adds the demands of the lanes.
    void (*gather)(const FullStreams&, const DelayRows& radar, const DelayRows& v2v, const LaneGroup&, double dt,
                   const FullGroup&);
    // Driver: computes the requested accelerations of the first `vehicles` of the group.
    void (*plan)(const DriverTablesOf<float>&, const FullGroup&, int vehicles, double dt, const FullStreams&,
                 NextSlots next);
    // Vehicle: computes the powertrain's response to the requests. `only`: index of the vehicle type to which the
    // tables belong; vehicles of other types stay as they are. Below 0: all vehicles have this type.
    void (*drive)(const PowertrainTablesOf<float>&, const FullGroup&, int vehicles, double dt, int only,
                  const FullStreams&, NextSlots next);
    // Writes the results back to the arrays of all vehicles, and moves the vehicles.
    void (*scatter)(const FullStreams&, Lanes, const FullGroup&, double dt);
};

// Returns the widest build that this machine supports. `scalar`: returns the build that computes one vehicle at a time,
// which serves as the oracle of the others.
const FullKernels& full_kernels(bool scalar);

}  // namespace stopline
