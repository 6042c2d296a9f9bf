// Detectors: positions on lanes at which the simulation records every vehicle whose front passes.
#pragma once

#include <cstdint>

namespace stopline {

struct Detector {
    enum class Kind : std::uint8_t {
        stop_line,
        zone,    // on the border of a zone, a part of the network in which traffic is measured
        exit,    // at the start of an exit lane, just after an intersection
        middle,  // in the middle of a lane between two intersections
        loop,    // induction loop with a name
        signal   // upstream of a stop line, for the controller of the signal
    };
    int lane = -1;  // -1: no position on a lane; the detector records the starts or ends of trips
    double position_m = 0.0;
    Kind kind = Kind::stop_line;
    int zone = -1;             // index of the zone; -1: the detector belongs to no zone
    bool leaves_zone = false;  // true: vehicles leave the zone at this detector; false: they enter the zone
    int loop = -1;             // index in Model::loop_names; -1: no induction loop
    double length_m = 0.0;     // length of the detection zone, which begins at the position
};

}  // namespace stopline
