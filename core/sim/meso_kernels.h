// The inner loops of the mesoscale mode, over plain arrays, and the choice among their builds. They are written as plain loops
// that the compiler vectorises; the scalar build of the same text, with that switched off, is their oracle.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/huge_page_allocator.h"
#include "driver/krauss.h"
#include "sim/lane_step.h"

namespace stopline {

// Vehicles of several lanes side by side, one value a vehicle.
struct MesoGroup {
    double* position;                                               // on its lane
    double *speed, *gap, *ahead, *ahead_acceleration, *more, *cap;  // see KraussInput
    double *to_turn, *limit;                                        // distance to the next lane's limit; this lane's
    double* next;                                                   // speed after the step
    int *id, *policy;
};

// The memory of a group.
class MesoGroupArrays {
public:
    void resize(int vehicles);
    MesoGroup streams();

private:
    LargeArray<double> doubles_;
    LargeArray<int> ints_;
    std::size_t vehicles_ = 0;
};

// Plain pointers to the arrays of all vehicles, [slot].
struct MesoStreams {
    double *position, *speed;
    const float *length, *end_speed;
    const int *id, *policy;
    float* acceleration;
};

// What draws of this step have in common: the state of the generator before the vehicle and the tick are mixed in.
struct MesoStep {
    double dt;
    std::uint64_t key;  // see dawdle_key
    std::uint64_t tick;
    double slow_down_mps2;  // towards a lower limit
    double approach_share;  // of what is missing to the limit, gained in this step
    double turn_share;      // of what is missing to what the way to a turn allows
};

struct MesoKernels {
    using Lanes = std::span<const LaneStep>;

    const char* name;
    // Brings the group together; returns how many overlap the vehicle ahead on their lane or, first of it, on the next.
    int (*gather)(const MesoStreams&, const LaneGroup&, const MesoStep&, const MesoGroup&);
    // `only`: treats vehicles of this policy; < 0: all are of the policy given.
    void (*follow)(const Krauss&, const MesoStep&, const MesoGroup&, int vehicles, int only);
    // The same for policies 0 and 1 in one pass.
    void (*follow_two)(const Krauss&, const Krauss&, const MesoStep&, const MesoGroup&, int vehicles);
    // Takes it apart again, and moves its vehicles. Lanes must be in the order of their slots, without others' vehicles between.
    void (*scatter)(const MesoStreams&, Lanes, const MesoStep&, const MesoGroup&);
};

const MesoKernels& meso_kernels(bool scalar);

}  // namespace stopline
