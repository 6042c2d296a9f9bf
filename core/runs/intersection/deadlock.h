// Deadlocks of a single intersection: a vehicle stays inside the intersection for too long without a lawful wait. The
// limit is the time of the slowest unobstructed crossing plus two signal cycles, or plus kMinDeadlock_s if this is
// longer. If the controller reacts to traffic, the longest possible cycle counts. The time counts from the last lawful
// wait.
//
// A vehicle waits lawfully if it yields to moving traffic, or if it is in a chain of waiting vehicles whose last one
// does. An example is a left-turning vehicle in a green that does not end. A lawful wait has no limit here. It counts
// as starvation instead (Starvation in sim/state/delay_log.h). Vehicles that wait for each other do not wait lawfully.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "sim/state/delay_log.h"
#include "sim/state/state.h"
#include "sim/step/simulation.h"

namespace stopline {

// In shorter stays, a vehicle can still be moving with the queue ahead of it.
inline constexpr double kMinDeadlock_s = 30.0;

// A vehicle of a deadlock, and what it waits for.
struct DeadlockMember {
    int vehicle = -1;                     // id
    int lane = -1;                        // connection inside the intersection, or another lane
    DelayCause cause = DelayCause::none;  // none: the vehicle waits only for the vehicle ahead, or it moves
    int waits_for = -1;                   // id of the stopped vehicle for which it waits; -1: none
};

// The first deadlock of a run.
struct Deadlock {
    int vehicle = -1;     // id of the vehicle that stays too long
    int lane = -1;        // connection of this vehicle
    double from_s = 0.0;  // entry into the intersection, or last lawful wait if that is later
    double to_s = 0.0;    // time at which the limit was exceeded
    // A chain of waiting vehicles. The first one is `vehicle`, and each one waits for the next one. The last one waits
    // for no stopped vehicle, or for one that is in the chain already. Empty: `vehicle` has not stopped.
    std::vector<DeadlockMember> members = {};
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
    void watch_occupants(const State& state);
    static std::vector<DeadlockMember> members_from(const State& state, int vehicle);
    static bool is_lawful(const std::vector<DeadlockMember>& members);

    const Model& model_;
    std::int64_t limit_ticks_;
    std::int64_t watched_ticks_;                    // shortest stay for which lawful waits are recorded
    std::map<int, std::int64_t> last_lawful_tick_;  // [vehicle] of the vehicles inside that have waited lawfully
    std::optional<Deadlock> deadlock_;
};

// Describes a deadlock: the vehicle, the time, and which vehicle waits for which. `lanes`: the names of all lanes.
std::string deadlock_text(const Deadlock& deadlock, const std::vector<std::string>& lanes);

}  // namespace stopline
