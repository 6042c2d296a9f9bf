#include "sim/clearing/short_exits.h"

#include <algorithm>

#include "base/containers/index.h"
#include "sim/clearing/keep_clear.h"

namespace stopline {

namespace {

// Returns true if a vehicle on the lane may have to stop at its end: the signal is not green, or the vehicle must yield
// there.
bool may_stop_at_end(const State& state, int lane) {
    const bool has_signal = state.plan.lane(lane).signal_group >= 0;
    return std::ranges::any_of(state.plan.next(lane), [&](int next) {
        if (state.plan.lane(next).yields) return true;
        return has_signal && state.signals.lights[at(state.plan.signal_group_for(lane, next))] != Light::green;
    });
}

}  // namespace

ShortExitCheck::ShortExitCheck(const Model& model, const State& state, int exit)
    : exit_(exit), needed_m_(0.0), last_slot_(-1) {
    count_lane(state, exit);
    for (const int connection : model.connections_to.of(exit)) count_lane(state, connection);
}

void ShortExitCheck::count_lane(const State& state, int lane) {
    const LaneBlock& block = state.blocks[at(lane)];
    for (int slot = block.first; slot < block.past_last(); ++slot) count(state, slot);
}

void ShortExitCheck::count(const State& state, int slot) {
    needed_m_ += space_needed_m(state.vehicles, slot);
    last_slot_ = slot;
}

int ShortExitCheck::blocker_of(const State& state, int slot) {
    const int ahead = last_slot_;
    count(state, slot);
    const bool has_room = needed_m_ <= state.plan.lane(exit_).next_limit_m;
    return has_room || !may_stop_at_end(state, exit_) ? -1 : ahead;
}

}  // namespace stopline
