// The memory of the dual-ring controller.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "signals/rings/ring_plan.h"
#include "signals/signal_state.h"

namespace stopline {

// red: the ring has no phase, or its phase is over and the other ring is not cleared yet.
enum class RingInterval : std::uint8_t { green, yellow, all_red, red };

// Numbers of a ring. kCurrentPhase: -1: none. kLastPlace: place of the last phase on the present side; -1: none.
// kClearing: groups that show yellow or red after the phase. kMaximumStart: tick from which the maximum green counts;
// -1: no call of another phase yet. kExtension: last decision tick at which a vehicle covered a detector of the phase.
// kPoint: tick of the next force-off point, or yield point of a coordinated phase.
inline constexpr std::size_t kRingInterval = 0;
inline constexpr std::size_t kCurrentPhase = 1;
inline constexpr std::size_t kFollowingPhase = 2;
inline constexpr std::size_t kIntervalStart = 3;
inline constexpr std::size_t kLastPlace = 4;
inline constexpr std::size_t kClearing = 5;
inline constexpr std::size_t kMaximumStart = 6;
inline constexpr std::size_t kExtension = 7;
inline constexpr std::size_t kPoint = 8;
inline constexpr std::size_t kNumbersOfRing = 9;

// The numbers of the whole signal come first. The numbers of the two rings follow, then the ticks at which the groups
// last lost green.
class RingMemory {
public:
    RingMemory(std::span<std::int64_t> numbers, const PhasePlan& plan) : numbers_(numbers), plan_(plan) {}
    static std::size_t size(std::size_t groups) { return kGroupEnds + groups; }

    std::int64_t& has_begun() { return numbers_[0]; }
    std::int64_t& side() { return numbers_[1]; }
    std::int64_t side() const { return numbers_[1]; }
    std::int64_t& is_crossing() { return numbers_[2]; }
    std::int64_t is_crossing() const { return numbers_[2]; }
    std::int64_t& at(std::size_t ring, std::size_t number) {
        return numbers_[kRingNumbers + ring * kNumbersOfRing + number];
    }
    std::int64_t at(std::size_t ring, std::size_t number) const {
        return numbers_[kRingNumbers + ring * kNumbersOfRing + number];
    }
    std::int64_t& green_end(int group) { return numbers_[kGroupEnds + static_cast<std::size_t>(group)]; }
    std::int64_t green_end(int group) const { return numbers_[kGroupEnds + static_cast<std::size_t>(group)]; }

    RingInterval interval(std::size_t ring) const { return static_cast<RingInterval>(at(ring, kRingInterval)); }
    int current(std::size_t ring) const { return static_cast<int>(at(ring, kCurrentPhase)); }
    int following(std::size_t ring) const { return static_cast<int>(at(ring, kFollowingPhase)); }
    bool has_green(std::size_t ring) const { return interval(ring) == RingInterval::green; }
    bool is_clearing(std::size_t ring, int group) const {
        return (static_cast<std::uint64_t>(at(ring, kClearing)) >> group & 1U) != 0;
    }
    // Returns true if the ring has a phase that gives green to the group.
    bool serves(std::size_t ring, int group) const {
        return current(ring) >= 0 && phase(current(ring)).has_green(group);
    }
    const SignalPhase& phase(int number) const { return plan_.phases[static_cast<std::size_t>(number)]; }

private:
    static constexpr std::size_t kRingNumbers = 3;
    static constexpr std::size_t kGroupEnds = kRingNumbers + kRings * kNumbersOfRing;

    std::span<std::int64_t> numbers_;
    const PhasePlan& plan_;
};

// Returns the green of a group that is certain to come or to last (SignalController::next_green). A later green depends
// on the traffic.
GreenWindow next_ring_green(const SignalView& view, int group, std::int64_t after_tick);

}  // namespace stopline
