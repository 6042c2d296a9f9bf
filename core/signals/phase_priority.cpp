#include "signals/phase_priority.h"

#include <cstddef>
#include <utility>

#include "base/input_error.h"

namespace stopline {

PhasePriority::PhasePriority(int first, int second, std::vector<PriorityStage> stages, std::int64_t offset_ticks)
    : first_(first), second_(second), stages_(std::move(stages)), offset_(offset_ticks) {
    if (stages_.empty()) throw InputError("right of way of a signal: at least one stage is needed");
    for (const PriorityStage& stage : stages_) {
        if (stage.ticks <= 0)
            throw InputError("right of way of a signal: every stage must last at least one time step");
        cycle_ += stage.ticks;
    }
}

PhasePriority::Place PhasePriority::place_at(std::int64_t tick) const {
    const std::int64_t in_cycle = ((tick - offset_) % cycle_ + cycle_) % cycle_;
    std::size_t stage = 0;
    std::int64_t end = stages_[0].ticks;
    while (in_cycle >= end) end += stages_[++stage].ticks;
    return {stage, tick - in_cycle + end};
}

Priority PhasePriority::at(std::int64_t tick) const { return stages_[place_at(tick).stage].priority; }

std::int64_t PhasePriority::next_change_tick(std::int64_t tick) const { return place_at(tick).end_tick; }

}  // namespace stopline
