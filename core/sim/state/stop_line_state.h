// Signals, stop lines and exit lanes in one step. Owner: sim/junction/stop_lines.cpp.
#pragma once

#include <cstdint>
#include <vector>

#include "signals/programme.h"

namespace stopline {

// The stop line at the end of a lane.
struct StopLineState {
    int stopping_vehicle = -1;    // id of the vehicle that stops for the signal; -1: none
    bool may_overrun = false;     // stopping needs more than 90 % of the maximum braking: overrunning is no violation
    int keep_clear_vehicle = -1;  // id of the vehicle that the keep-clear rule holds at green; -1: none
};

// The reason why the keep-clear rule holds a vehicle at a green signal.
struct KeepClearHold {
    int blocker = -1;      // slot of the stopped vehicle beyond the stop line; -1: none
    bool in_exit = false;  // the blocker is in the exit lane; false: in a conflict area
};

// Free length of an exit lane.
struct ExitRoom {
    std::int64_t tick = -1;  // step for which the values are valid
    double room_m = 1e9;  // up to the last stopped vehicle within sight, less the space of vehicles on their way there
    int stopped_slot = -1;  // slot of that vehicle; the lane's last vehicle if the whole lane will wait for its signal
};

struct StopLines {
    std::vector<Light> lights;                 // [signal group]
    std::vector<StopLineState> lines;          // [lane]
    std::vector<int> stop_slot;                // [lane] slot of the vehicle that stops at the line; -1: none
    std::vector<KeepClearHold> held_at_green;  // [lane] reason if the vehicle in stop_slot is held at green
    std::vector<ExitRoom> exit_rooms;          // [exit lane]
};

}  // namespace stopline
