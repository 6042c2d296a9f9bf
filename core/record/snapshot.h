// What a recording needs of the state of a run, copied between two steps so that it can be encoded while the run goes on.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/state.h"

namespace stopline {

struct Snapshot {
    struct Slots {
        int first = 0;
        int count = 0;

        int stop() const { return first + count; }
        bool operator==(const Slots&) const = default;
    };
    struct Standing {
        int slot = -1;     // now another's perhaps
        int vehicle = -1;  // its number
        Cause cause = Cause::none;
        int waited_for = -1;  // number of a vehicle; -1: none
    };

    std::int64_t tick = 0;
    std::int64_t entered = 0;  // vehicles so far
    std::int64_t left = 0;
    std::vector<Slots> lanes;  // [lane]
    // [slot]; where there is no vehicle they mean nothing.
    std::vector<int> vehicle;  // its number
    std::vector<int> policy;
    std::vector<int> next_lane;
    std::vector<double> position_m;  // front, from the lane's start
    std::vector<double> speed_mps;
    std::vector<float> length_m;
    std::vector<Standing> standing;  // at the last look at hindrance

    // Standing only if asked for: it changes less often than the rest.
    void take(const State& state, bool with_standing);
};

// The tick of the last look at hindrance, which is so often, before a state at that tick; -1: none.
inline std::int64_t look_tick_before(std::int64_t every_ticks, std::int64_t tick) {
    return every_ticks <= 0 || tick == 0 ? -1 : (tick - 1) / every_ticks * every_ticks;
}

}  // namespace stopline
