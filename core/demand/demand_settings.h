// What a user says of the traffic that enters. SI units.
#pragma once

#include <string>

namespace stopline {

struct DemandSettings {
    std::string kind = "queue";  // queue: `vehicles` a lane enter as soon as there is room, then none
    int vehicles = 60;
    double entry_speed_mps = 50.0 / 3.6;
};

}  // namespace stopline
