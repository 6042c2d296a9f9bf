// Inner loops of the mesoscale mode over plain arrays, and the choice among their builds for different instruction
// sets. The scalar build computes one vehicle at a time from the same source and serves as the oracle of the others.
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
    double slow_down_mps2;  // braking towards a lower limit
    double approach_share;  // share of the difference to the limit that is gained in a step
    double turn_share;      // the same for the difference to the speed allowed before a turn
    double leader_mps2;     // acceleration of platoon leaders; 0: that of their policy
    double leader_constant_power_speed_mps;
    const LeaderProfile* leader_profile;  // replaces the two values above; nullptr: none
    bool relays;                          // starts are relayed; platoon leaders then anticipate the vehicle ahead
    bool leaders_foresee;                 // platoon leaders use the followers' safe speed; needs relays
    double hardest_mps2;                  // maximum braking
    bool prefetches;                      // prefetches blocks, for more vehicles than the cache holds
};

// Gap in m that switching policies (SWITCH) add to their standstill gap. One value for each slot of the moving blocks,
// in their order; nullptr: 0 for all.
using ExtraGap = const double*;

struct MesoKernels {
    const char* name;
    // Slots in a block. The kernels treat whole blocks in place: slots [block * size, (block + 1) * size). Slots
    // without a vehicle keep their values.
    int size;
    // Moves the vehicles of `blocks` by one step. The blocks must ascend. The slot before a lane's first vehicle holds
    // the leader of that vehicle. Returns the number of vehicles that overlap their leader.
    int (*step)(const MesoStreams&, std::span<const int> blocks, std::span<const Krauss> policies, ExtraGap,
                const MesoStep&);
    // Evaluates the car-following equation alone, to measure its cost. Writes the next speeds of vehicles that fill
    // whole blocks. All arrays are indexed by vehicle.
    void (*follow)(const Krauss&, const MesoStep&, const KraussInputOf<const double*>&, std::span<const int> ids,
                   double* next_mps);
};

// Returns the widest build that this machine supports, or the scalar one.
const MesoKernels& meso_kernels(bool scalar);

}  // namespace stopline
