// The inner loops of the mesoscale mode, over plain arrays, and the choice among their builds. They are written as plain loops
// that the compiler vectorises; the scalar build of the same text, with that switched off, is their oracle.
#pragma once

#include <cstdint>
#include <span>

#include "driver/krauss.h"

namespace stopline {

// Plain pointers to the arrays of all vehicles, [slot].
struct MesoStreams {
    double *position, *speed;
    const double *limit, *turn, *imposed;
    const float *length, *end_speed;
    float *acceleration, *leads;
    const int *id, *policy;
};

// What draws of this step have in common: the state of the generator before the vehicle and the tick are mixed in.
struct MesoStep {
    double dt;
    std::uint64_t key;  // see dawdle_key
    std::uint64_t tick;
    double slow_down_mps2;  // towards a lower limit
    double approach_share;  // of what is missing to the limit, gained in this step
    double turn_share;      // of what is missing to what the way to a turn allows
    double leader_mps2;     // acceleration of platoon leaders; 0: that of their policy
    double leader_until_mps;
    const LeaderProfile* leader_profile;  // instead of these two; nullptr: none
    bool relays;                          // starts are relayed: leaders, too, know what the vehicle ahead will do
    bool leads_foreseeing;                // and no policy has a transient gap: their safe speed is that of followers
    double hardest_mps2;                  // braking
    bool fetches;                         // more vehicles than a cache holds: blocks are brought there ahead of time
};

// What policies with a gap that grows above a switching speed (SWITCH) add to their standstill gap, for the slots of each block in
// turn; nullptr: nothing.
using MesoMore = const double*;

struct MesoKernels {
    const char* name;
    // Vehicles are treated in whole blocks of this many slots, in place: slots [block * size, (block + 1) * size). What is in a slot without
    // a vehicle stays as it is.
    int size;
    // One step of the vehicles in these blocks, which ascend. The slot before a lane's first vehicle holds what that sees ahead. Returns how
    // many overlap the vehicle ahead.
    int (*step)(const MesoStreams&, std::span<const int> blocks, std::span<const Krauss> policies, MesoMore,
                const MesoStep&);
    // The equation alone, to measure what it costs: next speeds of vehicles in as many complete blocks. Arrays [vehicle].
    void (*follow)(const Krauss&, const MesoStep&, const KraussInputOf<const double*>&, std::span<const int> ids,
                   double* next_mps);
};

const MesoKernels& meso_kernels(bool scalar);

}  // namespace stopline
