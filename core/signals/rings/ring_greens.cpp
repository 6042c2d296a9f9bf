// The greens that the dual-ring controller can announce to vehicles. The shortest green of a phase is its minimum. A
// coordinated phase keeps its green up to its yield point.
#include <algorithm>

#include "signals/rings/ring_memory.h"

namespace stopline {

namespace {

class RingGreens {
public:
    RingGreens(SignalView view, int group)
        : view_(view), rings_(view_.plan().phases.rings), memory_(view_.memory(), view_.plan().phases), group_(group) {}

    // Returns the green that is certain to last, from its start to its earliest end. Green lasts as long as one of the
    // rings gives it.
    GreenWindow present() const {
        GreenWindow green{view_.green_start_tick(group_), view_.tick() + 1};
        for (std::size_t ring = 0; ring < kRings; ++ring) {
            if (!memory_.serves(ring, group_) || !memory_.has_green(ring)) continue;
            green.until_tick = std::max(green.until_tick, earliest_end(ring));
        }
        return green;
    }

    // Returns the green that begins after the yellow and red times that run now; unknown if no green of the
    // group follows these times.
    GreenWindow following() const {
        std::int64_t both_cleared_tick = view_.tick();
        for (std::size_t ring = 0; ring < kRings; ++ring)
            both_cleared_tick = std::max(both_cleared_tick, cleared_tick(ring));
        GreenWindow green;
        for (std::size_t ring = 0; ring < kRings; ++ring) {
            const int next = memory_.following(ring);
            const bool begins = memory_.is_crossing() != 0 || memory_.interval(ring) == RingInterval::yellow ||
                                memory_.interval(ring) == RingInterval::all_red;
            if (!begins || next < 0 || !memory_.phase(next).has_green(group_)) continue;
            // A group that the other ring clears gets green later, and perhaps not for the whole phase.
            if (memory_.is_crossing() == 0 && memory_.is_clearing(1 - ring, group_)) continue;
            const std::int64_t from_tick = memory_.is_crossing() != 0 ? both_cleared_tick : cleared_tick(ring);
            const GreenWindow own{from_tick, from_tick + memory_.phase(next).min_green_ticks};
            if (!green.is_known() || own.from_tick < green.from_tick) green = own;
        }
        return green;
    }

private:
    // Returns the tick before which the green of the ring does not end.
    std::int64_t earliest_end(std::size_t ring) const {
        const int number = memory_.current(ring);
        const std::int64_t minimum = memory_.at(ring, kIntervalStart) + memory_.phase(number).min_green_ticks;
        const bool waits = rings_.is_coordinated() && rings_.phases[static_cast<std::size_t>(number)].is_coordinated;
        return waits ? std::max(minimum, memory_.at(ring, kPoint)) : minimum;
    }

    // Returns the tick at which the ring is cleared of its present phase.
    std::int64_t cleared_tick(std::size_t ring) const {
        if (memory_.current(ring) < 0) return view_.tick();
        const SignalPhase& own = memory_.phase(memory_.current(ring));
        switch (memory_.interval(ring)) {
            case RingInterval::yellow:
                return memory_.at(ring, kIntervalStart) + own.yellow_ticks + own.all_red_ticks;
            case RingInterval::all_red:
                return memory_.at(ring, kIntervalStart) + own.all_red_ticks;
            case RingInterval::green:
            case RingInterval::red:
                break;
        }
        return view_.tick();
    }

    SignalView view_;
    const RingPlan& rings_;
    RingMemory memory_;
    int group_;
};

}  // namespace

GreenWindow next_ring_green(const SignalView& view, int group, std::int64_t after_tick) {
    const RingGreens greens(view, group);
    const GreenWindow green = view.light(group) == Light::green ? greens.present() : greens.following();
    return green.is_known() && green.until_tick > after_tick ? green : GreenWindow{};
}

}  // namespace stopline
