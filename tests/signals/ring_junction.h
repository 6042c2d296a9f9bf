// Signals with rings for tests of the controller `dual_ring`.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "signals/actuated_junction.h"

namespace stopline {

// Returns a phase in a ring. Its times are those of phase_of().
inline PhaseSettings ring_phase(int ring, int barrier, std::vector<std::string> movements, double min_green_s,
                                double green_s) {
    PhaseSettings phase = phase_of(std::move(movements), min_green_s, green_s);
    phase.ring = ring;
    phase.barrier = barrier;
    return phase;
}

// Returns the eight phases of NEMA with leading left turns. Phase k of the list has the number k + 1. All phases have
// the same minimum and green, so each ring takes 4 (green + 5 s).
inline SignalSettings eight_phases(double min_green_s = 5.0, double green_s = 20.0) {
    SignalSettings settings;
    settings.controller = "dual_ring";
    settings.first_green_s = 1.0;
    for (const int ring : {1, 2}) {
        for (const int barrier : {1, 2}) {
            const std::string side = barrier == 1 ? "west" : "south";
            const std::string opposite = barrier == 1 ? "east" : "north";
            const std::string left = ring == 1 ? side : opposite;
            const std::string straight = ring == 1 ? opposite : side;
            settings.phases.push_back(ring_phase(ring, barrier, {left + "_left"}, min_green_s, green_s));
            settings.phases.push_back(ring_phase(ring, barrier, {straight + "_straight"}, min_green_s, green_s));
        }
    }
    return settings;
}

// Returns the number of a movement in kMovements.
inline std::size_t movement(const std::string& name) {
    std::size_t k = 0;
    while (kMovements[k] != name) ++k;
    return k;
}

// The phases of both rings; -1: none.
inline RingPair pair_of(const Junction& junction) {
    if (junction.phase() < 0) return {};
    return junction.phases().rings.pairs[static_cast<std::size_t>(junction.phase())];
}

}  // namespace stopline
