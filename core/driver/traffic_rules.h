// Rules against junction blocking and gridlock, for queues that spill back into intersections (Section VI.A of the
// paper). By default only the keep-clear rule is active. SI units.
#pragma once

#include <string>

namespace stopline {

struct TrafficRules {
    // The keep-clear rule. A vehicle passes the stop line only if its exit lane has room for it and for the vehicles
    // between it and the exit lane. The room ends at the rearmost vehicle within sight_m that is slower than 1 m/s. The
    // vehicle also waits while such a slow vehicle from a crossing street blocks the path ahead, or has waited inside
    // the intersection since an earlier green and still has to cross the path ahead. The rule can fail, because a
    // moving vehicle in the exit lane may still stop.
    std::string keep_clear = "on";  // off | on
    double sight_m = 300.0;         // distance into the exit lane that drivers see; SUMO considers the whole lane
    // on: while the signal at the end of the exit lane is not green, moving vehicles on the exit lane count as already
    // stopped at that signal. SUMO has a similar rule: a lane counts as occupied if its rearmost vehicle must wait at
    // the end of the lane.
    std::string count_queue_at_red_exit = "on";  // off | on
    // Cooperative clearing: vehicles with V2V announce where they will come to rest. They pass the stop line only if
    // there is room for them beyond the intersection, even if all vehicles ahead stop as early as they may. Vehicles
    // without V2V obey the keep-clear rule.
    std::string clearing = "off";  // off | cooperative
    // If the first vehicle of a lane has been stopped for this many signal cycles, it is teleported past the
    // intersection as soon as there is room beyond it (SUMO: teleport). 0: never.
    double teleport_cycles = 0.0;
    // If a vehicle has been stopped inside an intersection for the duration of this many green times, it no longer
    // blocks crossing vehicles (SUMO: ignore-junction-blocker). If the green times of the signal groups differ, the
    // longest one is used. 0: never.
    double pass_blocker_greens = 0.0;
};

}  // namespace stopline
