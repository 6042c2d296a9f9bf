// Short exit lanes, with room for only a few vehicles (NetworkPlan::is_short()). A vehicle that enters such a lane may
// have to stop at its end, although it still moves now. The next vehicle would then stop inside the intersection.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// The part of the keep-clear rule for one short exit lane and the vehicles of one approach lane that enter it.
class ShortExitCheck {
public:
    // Counts the vehicles on the exit lane and on all connections to it.
    ShortExitCheck(const Model& model, const State& state, int exit);
    // Leaves the members uninitialised, so that an unused check costs nothing.
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init)
    ShortExitCheck() = default;

    // Returns the slot of the vehicle counted last if the vehicle in `slot` must wait for it before the intersection;
    // -1: the vehicle in `slot` need not wait. It must wait if vehicles may have to stop at the end of the exit lane
    // and the exit lane has no room for this vehicle and all vehicles counted before it. Counts the vehicle in `slot`.
    // So the vehicles of an approach lane must be checked from the first one on.
    int blocker_of(const State& state, int slot);

private:
    void count(const State& state, int slot);
    void count_lane(const State& state, int lane);

    int exit_;
    double needed_m_;  // space that the counted vehicles need in a queue
    int last_slot_;    // slot of the vehicle counted last; -1: none
};

}  // namespace stopline
