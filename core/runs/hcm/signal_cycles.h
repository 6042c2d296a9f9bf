// Counts the cycles of each signal in a run, for lanes that can have several greens in a cycle, or none. A controller
// that skips phases has cycles of different lengths, and a lane then has fewer greens in some of them.
//
// A cycle begins when the controller starts the same phase again, starts an earlier phase of its sequence, or changes
// to another programme. With rings, it begins when the rings return to an earlier group of phases between barriers.
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
    // for groups with one green in each cycle, and for signals that have neither phases nor a programme.
    std::int64_t number(int group) const;
    // Returns the tick at which this cycle began. The group must have a cycle.
    std::int64_t start_tick(int group) const;

private:
    struct Signal {
        std::int64_t number = kNoCycle;
        std::int64_t start_tick = 0;  // of the cycle
        int phase = -1;
        std::int64_t phase_start_tick = -1;
    };

    const Model& model_;
    std::vector<Signal> signals_;        // [signal]
    std::vector<bool> greens_can_vary_;  // [signal group] the group can have several greens in a cycle, or none
};

}  // namespace stopline
