// What a user says of the network: the parameters of a generator. SI units.
#pragma once

#include <string>
#include <vector>

namespace stopline {

// One straight approach with a stop line, and the road behind it.
struct ApproachSettings {
    int lanes = 1;
    double length_m = 700.0;       // entry to stop line
    double exit_length_m = 700.0;  // stop line to the end of the network
    double speed_limit_mps = 50.0 / 3.6;
    double gradient = 0.0;  // rise over run, positive uphill
};

// Four arms at right angles, all alike.
struct IntersectionSettings {
    struct LaneMovements {
        std::string movements;  // of left, straight and right, joined by +
    };
    std::vector<LaneMovements> lanes = {};  // of each arm, from the left
    double radius_m = 20.0;                 // centre to stop line
    double approach_length_m = 200.0;       // entry to stop line
    double exit_length_m = 100.0;
    double lane_width_m = 3.5;
    double speed_limit_mps = 50.0 / 3.6;
    double turn_speed_mps = 7.0;  // 2.5 m/s2 lateral on a radius of 20 m (Section IV.A)
    double clearance_m = 2.0;     // between centre lines below which vehicles touch: a car's width and a little more
};

struct NetworkSettings {
    std::string kind = "approach";
    ApproachSettings approach;
    IntersectionSettings intersection;
};

}  // namespace stopline
