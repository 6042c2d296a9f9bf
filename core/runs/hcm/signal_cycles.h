// Counts the cycles of each signal in a run, for lanes that have several greens in a cycle. A controller that skips
// phases has cycles of different lengths, and a lane then has fewer greens in some of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

class SignalCycles {
public:
    static constexpr std::int64_t kNoCycle = -1;

    // The model must outlive the object.
    explicit SignalCycles(const Model& model);

    // Must be called in the order of time, often enough to see every phase.
    void update(const State& state);

    // Returns the number of the cycle in which the signal of a group is. The numbers rise with time. Returns kNoCycle
    // for groups with one green in a cycle, and for signals that have neither phases nor a programme.
    std::int64_t number(int group) const;

private:
    struct Signal {
        std::int64_t number = kNoCycle;
        int phase = -1;
        std::int64_t phase_start_tick = -1;
    };

    const Model& model_;
    std::vector<Signal> signals_;           // [signal]
    std::vector<bool> has_several_greens_;  // [signal group] the group can have several greens in a cycle
};

}  // namespace stopline
