// Detectors: positions on lanes where the passage of fronts is recorded.
#pragma once

#include <cstdint>

namespace stopline {

struct Detector {
    enum class Kind : std::uint8_t {
        stop_line,
        zone,    // border of a measuring zone
        exit,    // behind an intersection
        middle,  // middle of a link
        loop     // named detector of the scenario
    };
    int lane = -1;
    double position_m = 0.0;
    Kind kind = Kind::stop_line;
    int zone = -1;             // index of the zone that it borders
    bool leaves_zone = false;  // vehicles leave the zone here; false: they enter it
    int loop = -1;             // index of the name of a loop
};

}  // namespace stopline
