// The state of stop lines and exit lanes in one step. Owner: sim/junction/stop_lines.cpp.
#pragma once

#include <cstdint>

#include "base/simd/huge_page_allocator.h"

namespace stopline {

// The stop line at the end of a lane.
struct StopLineState {
    int stopping_vehicle = -1;  // id of the vehicle that stops at the line for the signal; -1: none
    // True (only in full dynamics): stopping_vehicle needs more than 90 % of the maximum braking to stop at the line.
    // It is then no violation if this vehicle overruns the line.
    bool may_overrun = false;
    int keep_clear_vehicle = -1;  // id of the vehicle that the keep-clear rule holds at green; -1: none
    // Id of the vehicle that stops at the line by the latest decision for this lane, whatever the reason; -1: none. It
    // is the vehicle in StopLines::stop_slot at the time of that decision. Its slot may have changed since then.
    int stop_id = -1;
};

// The reason why the keep-clear rule or cooperative clearing holds a vehicle at a green signal.
struct KeepClearHold {
    // Slot of the vehicle that blocks the way; -1: none, or the rule holds no vehicle. For a short exit lane, the last
    // vehicle that enters the lane first. It can still be before the stop line.
    int blocker = -1;
    bool in_exit = false;     // true: the exit lane has no room; false: the blocker is in a conflict area
    bool is_refusal = false;  // true: cooperative clearing has refused the vehicle; blocker can then be -1
};

inline constexpr double kAmpleRoom_m = 1e9;  // room on an exit lane for any number of vehicles

// The free length of an exit lane, as the keep-clear rule computes it.
struct ExitRoom {
    std::int64_t tick = -1;  // tick of the step for which the values are valid
    // Room for further vehicles, measured from the start of the lane. The space for the vehicles on the connections to
    // the lane is already subtracted.
    // - If a vehicle is stopped (slower than kCrawlingSpeed_mps, 1 m/s): the distance to the rear of the stopped
    //   vehicle furthest upstream, minus the space for the moving vehicles upstream of it.
    // - If no vehicle is stopped, the signal at the end of the lane is not green and RulesPlan::count_queue_at_red_exit
    //   is true: the distance to the stopping position at the stop line, minus the space for the moving vehicles.
    // - In all other cases, and beyond RulesPlan::sight_m: kAmpleRoom_m.
    double room_m = kAmpleRoom_m;
    // Slot of the stopped vehicle at which the free length ends. If all vehicles move but count as stopped at a red
    // signal: slot of the vehicle furthest upstream on the lane. -1: none.
    int stopped_slot = -1;
};

struct StopLines {
    LargeArray<StopLineState> lines;          // [lane]
    LargeArray<int> stop_slot;                // [lane] slot of the vehicle that stops at the line; -1: none
    LargeArray<KeepClearHold> held_at_green;  // [lane] why the keep-clear rule holds the vehicle in stop_slot
    LargeArray<ExitRoom> exit_rooms;          // [exit lane]
};

}  // namespace stopline
