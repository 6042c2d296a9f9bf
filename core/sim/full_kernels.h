// The inner loops of the full-dynamics fidelity, over plain arrays, and the choice among their builds.
#pragma once

#include <span>

#include "driver/acceleration_laws.h"
#include "sim/full_group.h"
#include "sim/state.h"
#include "vehicle/powertrain_tables.h"

namespace stopline {

// Plain pointers to the arrays of all vehicles in one step, [slot].
struct FullStreams {
    double *position, *speed;
    const float *length, *standstill_gap, *end_speed;
    const int *policy, *type;  // null where the model has one alone
    float *acceleration, *lag, *request, *leads, *torque, *brake, *gear_time, *gear;
    // Rows of the delay lines.
    float *gap_now, *closing_now, *tell_acceleration, *tell_request, *tell_rate;
    const float *gap_late, *gap_later, *closing_late, *closing_later;
    const float *heard_acceleration, *heard_request, *heard_rate;
    const float *earlier_acceleration, *earlier_request, *earlier_rate;
};

// The kernels of one step of a group of lanes, in this order.
struct FullKernels {
    using Lanes = std::span<const LaneStep>;
    using NextSlots =
        std::span<const int>;  // a slot in each line of the cache that the next group needs; empty: they are there

    const char* name;
    // Brings the group together: measures, looks up what is known of predecessors, and what lanes ask of their vehicles.
    void (*gather)(const FullStreams&, const Rows& radar, const Rows& v2v, const LaneGroup&, double dt,
                   const FullGroup&);
    // Driver: what acceleration is asked for, for the first `vehicles` of the group. `next`: see NextSlots.
    void (*plan)(const DriverTablesOf<float>&, const FullGroup&, int vehicles, double dt, const FullStreams&,
                 NextSlots next);
    // Vehicle: what the powertrain makes of it. `only`: treats vehicles of this type; < 0: all are of the type given.
    void (*drive)(const PowertrainTablesOf<float>&, const FullGroup&, int vehicles, double dt, int only,
                  const FullStreams&, NextSlots next);
    // Takes the group apart again, and moves its vehicles.
    void (*scatter)(const FullStreams&, Lanes, const FullGroup&, double dt);
};

// The widest build that this machine runs, or the scalar one: one vehicle at a time, the oracle of the others.
const FullKernels& full_kernels(bool scalar);

}  // namespace stopline
