// The rings of a signal (NEMA TS 2). The phases of one ring run one after the other. Those of two rings can run
// together if they lie on the same side of the barriers. Both rings cross a barrier at the same time.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "signals/programme.h"
#include "signals/signal_settings.h"

namespace stopline {

struct PhasePlan;  // signals/signal_phases.h

inline constexpr std::size_t kRings = 2;

// The place of a phase in the rings, and its points in the background cycle. Times are in ticks.
struct RingPhase {
    std::size_t ring = 0;
    int side = 0;   // number of the barrier side, from 0
    int place = 0;  // number among the phases of its ring and side, from 0
    bool has_dual_entry = false;
    bool is_coordinated = false;
    std::uint64_t protected_groups = 0;
    std::int64_t start_point = 0;  // latest start of green, from the start of the background cycle
    std::int64_t force_off = 0;    // latest end of green; for a coordinated phase also the earliest one (yield point)
};

// Phases that run together. -1: the ring is red.
struct RingPair {
    std::array<int, kRings> phase{-1, -1};

    bool operator==(const RingPair&) const = default;
};

struct RingPlan {
    std::vector<RingPhase> phases;  // [phase of PhasePlan::phases]
    // [ring][side] phases in the order of their greens
    std::array<std::vector<std::vector<int>>, kRings> order;
    std::vector<RingPair> pairs;                  // all pairs that can occur
    std::array<int, kRings> coordinated{-1, -1};  // coordinated phase of each ring; -1: none
    std::int64_t cycle_ticks = 0;                 // background cycle; 0: no coordination
    std::int64_t cycle_start_tick = 0;            // start of a background cycle

    bool empty() const { return phases.empty(); }
    bool is_coordinated() const { return cycle_ticks > 0; }
    int sides() const { return static_cast<int>(order[0].size()); }
    // Returns the index of a pair in `pairs`.
    int pair(const RingPair& wanted) const;
    // Returns the ticks from `tick` to the next time at which the background cycle is at `point`; 0 if it is there.
    std::int64_t ticks_to(std::int64_t point, std::int64_t tick) const {
        return ((point - (tick - cycle_start_tick)) % cycle_ticks + cycle_ticks) % cycle_ticks;
    }
};

// Converts the settings. The background cycle starts at the first green. `movements`: the name of a movement of each
// group of the signal.
RingPlan make_ring_plan(const SignalSettings& settings, std::span<const std::string> movements, double step_s);

// Returns the phases of each pair of RingPlan::pairs as one phase each, with the movements of both. A movement is
// protected in the pair if one of the two phases protects it. The times are those of the first phase.
std::vector<PhaseSettings> ring_pair_phases(const SignalSettings& settings);

// Returns the text for two phases of a pair, such as `phases 2 and 6`. Phases count from 1.
std::string pair_text(const RingPair& pair);

// Returns programmes in which each phase has its green time. A ring waits in its last phase before a barrier. The
// programmes repeat.
std::vector<GroupProgramme> make_ring_programmes(const PhasePlan& plan, int groups);

// Returns the sum over the sides of the barriers of the longer ring, s: the cycle in which each phase has its green
// time.
double ring_cycle_s(const SignalSettings& settings);

}  // namespace stopline
