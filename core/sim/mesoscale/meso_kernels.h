// Inner loops (kernels) of the mesoscale mode over plain arrays. There is one build for each instruction set, and
// meso_kernels() selects one of them. The scalar build computes one vehicle at a time from the same source and is the
// reference for all other builds.
#pragma once

#include <cstdint>
#include <span>

#include "driver/krauss.h"

namespace stopline {

// Plain pointers to the arrays of all vehicles, indexed by slot. SI units.
struct MesoStreams {
    double *position, *speed;
    const double *limit, *next_limit, *speed_cap;
    const float *length, *end_speed;
    float *acceleration, *is_platoon_leader;
    const int *id, *policy;
};

// Constants of one step. SI units.
struct MesoStep {
    double dt;
    std::uint64_t key;  // random key of the dawdling, from dawdle_key()
    std::uint64_t tick;
    double slow_down_mps2;  // deceleration before a lower speed limit
    double approach_share;  // share of the difference to the speed limit that a slower vehicle gains in a step
    double turn_share;      // share of the difference to the allowed speed before a turn that a vehicle gains in a step
    double leader_mps2;     // acceleration of platoon leaders; 0: they accelerate as their policy
    double leader_constant_power_speed_mps;  // above this speed leader_mps2 falls as 1 / v
    const LeaderProfile* leader_profile;     // replaces the two values above; nullptr: they apply
    bool relays;           // V2V relays starts; platoon leaders then anticipate the speed of the vehicle ahead
    bool leaders_foresee;  // platoon leaders use the safe speed computed for followers; requires `relays`
    double hardest_mps2;   // maximum braking
    bool prefetches;       // the kernels prefetch blocks, because the vehicles do not fit into the cache
};

// Gap in m that switching policies (SWITCH) add to their standstill gap. The array has one value for each slot of the
// moving blocks, in the same order; nullptr: 0 for all slots.
using ExtraGap = const double*;

struct MesoKernels {
    const char* name;
    // Number of slots in a block. Block b holds the slots [b * size, (b + 1) * size). The kernels update whole blocks
    // in place. Slots without a vehicle keep their values.
    int size;
    // Moves the vehicles of `blocks` by one step. `blocks` must be in ascending order. The slot before a lane's first
    // vehicle must hold the leader of the first vehicle. Returns the number of vehicles that overlap their leader.
    int (*step)(const MesoStreams&, std::span<const int> blocks, std::span<const Krauss> policies, ExtraGap,
                const MesoStep&);
    // Evaluates the car-following equation alone, to measure its computing time. Writes the next speed of each vehicle.
    // All arrays are indexed by vehicle, and the number of vehicles must be a multiple of `size`.
    void (*follow)(const Krauss&, const MesoStep&, const KraussInputOf<const double*>&, std::span<const int> ids,
                   double* next_mps);
};

// Returns the kernels with the widest vectors that this machine supports. `scalar`: returns the scalar build.
const MesoKernels& meso_kernels(bool scalar);

}  // namespace stopline
