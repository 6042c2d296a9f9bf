// Deadlocks of a single intersection: a vehicle stays inside the intersection for two signal cycles longer than the
// slowest unobstructed crossing takes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sim/state/delay_log.h"
#include "sim/step/simulation.h"

namespace stopline {

// The first deadlock of a run.
struct Deadlock {
    int vehicle = -1;     // id of the vehicle that stays too long
    int lane = -1;        // connection of this vehicle
    double from_s = 0.0;  // time at which it entered the intersection
    double to_s = 0.0;    // time at which its stay became too long
    // The vehicles that waited for each other at that time: each waits for the next one, the last one for the first
    // one. Empty: there was no such ring.
    Gridlock ring = {};
};

// Finds the first deadlock of a run. The model must record delay causes (RulesPlan::watch_ticks).
class DeadlockSearch {
public:
    // `limit_s`: shortest stay that counts as a deadlock.
    DeadlockSearch(const Model& model, double limit_s);

    // Call this function after each step.
    void observe(const State& state);
    const std::optional<Deadlock>& deadlock() const { return deadlock_; }

private:
    const Model& model_;
    std::int64_t limit_ticks_;
    std::optional<Deadlock> deadlock_;
};

// Describes a deadlock: the vehicle, the time, and which vehicle waits for which. `lanes`: the names of all lanes.
std::string deadlock_text(const Deadlock& deadlock, const std::vector<std::string>& lanes);

}  // namespace stopline
