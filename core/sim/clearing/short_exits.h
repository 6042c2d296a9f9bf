// Short exit lanes, with room for only a few vehicles (NetworkPlan::is_short()). If a vehicle on such a lane stops at
// its end, the lane has no room behind it. A vehicle that followed would stop inside the intersection. So the
// keep-clear rule counts moving vehicles, too.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Decides for one short exit lane which vehicles of one approach lane may enter it. Part of the keep-clear rule.
class ShortExitCheck {
public:
    // Counts the vehicles on the exit lane that may have to stop at its end, and the vehicles on all connections to it.
    ShortExitCheck(const Model& model, const State& state, int exit);
    // Leaves the members uninitialised, so that an unused check costs nothing.
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init)
    ShortExitCheck() = default;

    // Counts the vehicle in `slot` of the approach lane `approach`. Returns the slot of the vehicle counted before it
    // if the vehicle must wait before the intersection; -1: it need not wait. A vehicle must wait under three
    // conditions. At least one vehicle was counted before it, and the last of these is not stopped on the approach
    // lane. Vehicles may have to stop at the end of the exit lane. The lane has no room for all counted vehicles. Call
    // this in driving order, from the first vehicle of the approach lane on.
    int count_and_find_blocker(const Model& model, const State& state, int approach, int slot);

private:
    void count(const State& state, int slot);

    int exit_;
    double needed_m_;  // space that the counted vehicles need in a queue
    int last_slot_;    // slot of the vehicle counted last; -1: none
};

}  // namespace stopline
