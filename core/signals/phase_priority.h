// Right of way between two connections that one signal controls, if the right of way changes with the phases of this
// signal.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace stopline {

// Says which of two connections yields to the other. Both can yield.
struct Priority {
    bool first_yields = false;
    bool second_yields = false;

    bool operator==(const Priority&) const = default;
};

// The right of way of two connections in each phase of a signal with phases (signals/signal_phases.h).
struct PriorityByPhase {
    int signal = 0;   // index of the signal
    int first = -1;   // lane index of a connection
    int second = -1;  // lane index of the other connection
    // [phase] A phase without a value keeps the right of way of the phase before it, because vehicles that entered in
    // that phase may still be inside.
    std::vector<std::optional<Priority>> by_phase;
};

struct PriorityStage {
    std::int64_t ticks = 0;  // duration
    Priority priority;
};

// The right of way of two connections over time. The stages repeat without end. The first stage begins at the tick
// `offset_ticks`, which may be negative.
class PhasePriority {
public:
    // Throws InputError if there is no stage or if a stage lasts less than one tick.
    PhasePriority(int first, int second, std::vector<PriorityStage> stages, std::int64_t offset_ticks);

    int first() const { return first_; }    // lane index of a connection
    int second() const { return second_; }  // lane index of the other connection
    const std::vector<PriorityStage>& stages() const { return stages_; }
    Priority at(std::int64_t tick) const;
    // Returns the first tick after `tick` at which a stage begins.
    std::int64_t next_change_tick(std::int64_t tick) const;

private:
    struct Place {
        std::size_t stage;
        std::int64_t end_tick;
    };
    Place place_at(std::int64_t tick) const;

    int first_;
    int second_;
    std::vector<PriorityStage> stages_;
    std::int64_t offset_;
    std::int64_t cycle_ = 0;
};

}  // namespace stopline
