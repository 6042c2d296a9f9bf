// Inner loops (kernels) of full dynamics over plain arrays. The kernels are compiled once for each instruction set, and
// full_kernels() selects one version.
#pragma once

#include <span>

#include "driver/acceleration_laws.h"
#include "sim/full_dynamics/receive_kernels.h"
#include "sim/state/state.h"
#include "sim/state/vehicles/full_group.h"
#include "vehicle/powertrain_tables.h"

namespace stopline {

// Plain pointers to the arrays of all vehicles, indexed by slot. SI units.
struct FullStreams {
    double *position, *speed;
    const float *length, *standstill_gap, *end_speed;
    const int *policy, *type;  // policy: null if the model has one policy; type: null if the model has one type
    float *acceleration, *lag, *request, *is_platoon_leader, *torque, *brake, *gear_time, *gear;
    // Rows that store the radar and V2V samples of the present and previous steps (DelayRows). The kernels write the
    // samples of this step into the rows `..._now` and `sent_...`. They read delayed samples from `..._delayed`,
    // `..._older` and `heard_...`. The V2V rows are null with an active V2V channel, which stores messages itself.
    float *gap_now, *closing_now, *sent_acceleration, *sent_request, *sent_rate;
    const float *gap_delayed, *gap_older, *closing_delayed, *closing_older;
    const float *heard_acceleration, *heard_request, *heard_rate;
    const float *heard_acceleration_older, *heard_request_older, *heard_rate_older;
};

// The kernels of one step. For each lane group they are called in the order of the members. `plan` or `plan_human` is
// called once for each driver, and `drive` once for each vehicle type.
struct FullKernels {
    using Lanes = std::span<const LaneStep>;
    // Slots whose data are prefetched: one for each cache line of the next group. Empty: no prefetch.
    using NextSlots = std::span<const int>;

    const char* name;
    // Fills the group from the arrays of all vehicles: takes the radar measurements, and reads the delayed data about
    // the leaders. FullGroup::demand becomes the lowest of the accelerations that stop lines, yielding, speed targets
    // and hidden leaders demand of the vehicle (LaneGroup::demands).
    void (*gather)(const FullStreams&, const DelayRows& radar, const DelayRows& v2v, const LaneGroup&, double dt,
                   const FullGroup&);
    // The receive phase of V2V (receive_messages.h). `list_due` stores the own speeds, and lists the vehicles that the
    // receive phase must treat and those that send in this step (ReceiveWork). `receive` writes what the vehicles know
    // about their leaders into the group.
    void (*list_due)(const ReceiveStreams&, Lanes, int tick, const FullGroup&, const ReceiveLists&);
    void (*receive)(const ReceiveStep&, const ReceiveStreams&, Lanes, const FullGroup&, ReceiveResults&);
    // Driver: computes the requested accelerations of the first `vehicles` vehicles of the group. `only`: index of the
    // driver to which the tables belong. Vehicles with other drivers stay unchanged. If `only` is below 0, the tables
    // apply to all vehicles.
    void (*plan)(const DriverTablesOf<float>&, const FullGroup&, int vehicles, double dt, int only, const FullStreams&,
                 NextSlots next);
    // The same for human drivers (driver/human.h). FullGroup::interaction must be set (human_perception.h).
    void (*plan_human)(const DriverTablesOf<float>&, const FullGroup&, int vehicles, double dt, int only,
                       const FullStreams&, NextSlots next);
    // Vehicle: computes the response of the powertrain to the requests. `only`: index of the vehicle type to which the
    // tables belong. Vehicles of other types stay unchanged. If `only` is below 0, the tables apply to all vehicles.
    void (*drive)(const PowertrainTablesOf<float>&, const FullGroup&, int vehicles, double dt, int only,
                  const FullStreams&, NextSlots next);
    // Writes the results back to the arrays of all vehicles, and moves the vehicles.
    void (*scatter)(const FullStreams&, Lanes, const FullGroup&, double dt);
};

// Returns the kernels with the widest vectors that this machine supports. If `scalar` is true, returns the kernels that
// compute one vehicle at a time. These are the reference for all other versions.
const FullKernels& full_kernels(bool scalar);

}  // namespace stopline
