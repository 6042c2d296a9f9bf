// Inner loops (kernels) of the mesoscale mode over plain arrays. The kernels are compiled once for each instruction
// set, and meso_kernels() selects one version. The scalar version is compiled from the same source, but computes one
// vehicle at a time. It is the reference for all other versions.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "driver/acceleration_profile.h"
#include "driver/following_model.h"
#include "sim/mesoscale/following_types.h"

namespace stopline {

// Plain pointers to the arrays of all vehicles, indexed by slot. SI units.
struct MesoStreams {
    double *position, *speed;
    const double *limit, *next_limit, *speed_cap;
    const float *length, *end_speed;
    float *acceleration, *is_platoon_leader;
    const int *id, *policy;
    const int* start_ticks;  // steps since the leader began to move; nullptr: no human drivers
};

// Constants of one step. SI units.
struct MesoStep {
    double dt;
    std::uint64_t key;         // key of the random numbers for dawdling, from dawdle_key()
    std::uint64_t driver_key;  // key of the random numbers of drivers, from driver_key()
    std::uint64_t tick;
    double slow_down_mps2;  // deceleration before a lower speed limit
    // [policy] deceleration before a lower speed limit; nullptr: all drivers have slow_down_mps2
    const double* slow_downs_mps2;
    double approach_share;  // a vehicle below the speed limit gains at most this share of (limit - speed) in a step
    // Part of its deviation from the braking curve that a vehicle corrects in one step. The braking curve leads to a
    // lower speed limit ahead, such as that of a turn. At each position, it gives the highest speed from which a
    // vehicle that brakes with slow_down_mps2 reaches this limit in time.
    double turn_share;
    double leader_mps2;                      // acceleration of platoon leaders; 0: acceleration of the vehicle's policy
    double leader_constant_power_speed_mps;  // above this speed, leader_mps2 falls as 1 / speed
    // Acceleration of platoon leaders by speed. If it is not nullptr, the kernels ignore leader_mps2 and
    // leader_constant_power_speed_mps.
    const AccelerationProfile* leader_profile;
    // Lower bound of the acceleration, as a table by speed. On lanes with a speed limit above calibrated_limit_mps, a
    // vehicle that speeds up freely accelerates at least at this rate. nullptr: no lane has such a limit.
    const AccelerationProfile* power_profile;
    double calibrated_limit_mps;
    // [policy] highest acceleration of the vehicles, as a table by speed (Model::acceleration_limits). nullptr: the
    // car-following models alone limit the accelerations.
    const AccelerationProfile* acceleration_limits;
    // True: V2V relays the start of a queue, and platoon leaders anticipate the speed of the vehicle ahead.
    bool relays;
    // True: a platoon leader has the same safe speed as a follower, so the kernels compute the safe speed only once.
    // Requires `relays`, and FollowingModel::leader_uses_following_speed() of all policies.
    bool leaders_use_following_speed;
    double hardest_mps2;    // maximum deceleration behind a leader
    double emergency_mps2;  // maximum deceleration before a lower speed limit
    bool prefetches;        // true: the kernels prefetch blocks; useful if the vehicle data do not fit into the cache
};

// Extra gap of each vehicle at its current speed, m: the part of its desired gap beyond standstill gap plus time gap
// times speed (MesoGap). The array has one value for each slot of the blocks that move, in the order of the blocks.
// nullptr: 0 for all slots.
using ExtraGap = const double*;

// The kernels of one car-following model for one instruction set.
struct MesoKernels {
    using Models = std::span<const FollowingModel>;  // [policy]

    const char* name;
    // Number of slots in a block. Block b holds the slots [b * size, (b + 1) * size). The kernels update whole blocks
    // in place. Slots without a vehicle keep their values. The size is the same for all models.
    int size;
    // Moves the vehicles of `blocks` by one step. All policies must have the model of the kernels. `blocks` must be in
    // ascending order. The slot before a lane's first vehicle must hold a copy of this vehicle's leader. Returns the
    // number of vehicles that overlap their leader.
    int (*step)(const MesoStreams&, std::span<const int> blocks, Models, ExtraGap, const MesoStep&);
    // The same for policies with several models. The kernels of all models have the same function here.
    int (*step_mixed)(const MesoStreams&, std::span<const int> blocks, Models, ExtraGap, const MesoStep&);
    // Computes the next speeds of the vehicles with one policy in the block that begins at `slot`. step_mixed() calls
    // this function. `extra_gap` and `next_mps` have one value for each slot of the block.
    void (*block_speeds)(const MesoStreams&, int slot, const FollowingModel&, int policy, const double* extra_gap,
                         const MesoStep&, double* next_mps);
    // Evaluates the car-following equation alone, to measure its computing time. Writes the next speed of each vehicle.
    // All arrays are indexed by vehicle, and the number of vehicles must be a multiple of `size`.
    void (*follow)(const FollowingModel&, const MesoStep&, const FollowingInputOf<const double*>&,
                   std::span<const int> ids, double* next_mps);
};
using MesoKernelsOfTypes = std::array<MesoKernels, FollowingTypes::kCount>;

// Returns the kernels of a registered model with the widest vectors that this machine supports. `type` is the place of
// the model in FollowingTypes. If `scalar` is true, returns the scalar version.
const MesoKernels& meso_kernels(int type, bool scalar);

// Moves vehicles with the kernels of the models: those of one model if all policies have it, else the mixed ones. The
// parameters and the result are those of MesoKernels::step.
int step_blocks(bool scalar, const MesoStreams& streams, std::span<const int> blocks, MesoKernels::Models models,
                ExtraGap extra_gap, const MesoStep& step);

// Returns MesoKernels::size.
int meso_block_size(bool scalar);

}  // namespace stopline
