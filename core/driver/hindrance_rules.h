// Rules that keep traffic going where queues reach back into intersections (Section VI.A of the paper). All are off unless a
// scenario asks for them. SI units.
#pragma once

#include <string>

namespace stopline {

struct HindranceRules {
    // The no-block rule: nobody passes the stop line unless the exit has room for it and for those ahead on their way there,
    // before the last vehicle that stands or crawls (1 m/s) within sight, nor while somebody from the streets that cross does
    // so across its way. It can fail: who moves there may stop.
    std::string keep_clear = "off";  // off | on
    double sight_m = 300.0;          // into the exit, of which SUMO's rule takes in all
    // Those who move in the exit count as if they stood up to the light at its end while that is not green: SUMO's rule takes a
    // lane whose last vehicle has to wait at its end like one where somebody stands.
    std::string light_ahead = "on";  // off | on
    // The first vehicle of a lane that has stood for as long as this is moved on past the intersection, as soon as there is
    // room (SUMO's teleport); 0: never.
    double teleport_cycles = 0.0;
    // A vehicle that has stood inside an intersection for as long as this no longer holds up those that cross its way (SUMO's
    // ignore-junction-blocker); in greens, the longest where they differ; 0: never.
    double pass_blocker_greens = 0.0;
};

}  // namespace stopline
