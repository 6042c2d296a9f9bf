// Streets that a user describes: intersections with positions, lanes, programmes. SI units.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace stopline {

struct StreetLane {
    std::string movements;  // of left, straight and right, joined by +
    double pocket_m = 0.0;  // from where it begins to the stop line; 0: as long as the approach
};

// What an intersection has on one side: lanes that lead to it, and lanes that lead away on the same side.
struct StreetArm {
    std::string from = "west";  // the side that its traffic comes from: west, south, east or north
    std::vector<StreetLane> lanes = {};
    int exits = 0;
    double speed_limit_mps = 50.0 / 3.6;
    double right = 0.0;  // shares of the turns, the rest goes straight on
    double left = 0.0;
    // Where the arm leads to the border of the network: how far before the stop line its lanes begin, and how far behind the
    // intersection its exits end.
    double length_m = 300.0;
    double exit_length_m = 100.0;
};

// The seven steps of Table 3; major is the street from west to east.
struct SevenSteps {
    double major_green_s = 24.0;
    double major_yellow_s = 3.0;
    double major_clearance_s = 9.0;
    double protected_left_s = 0.0;
    double minor_green_s = 12.0;
    double minor_yellow_s = 3.0;
    double minor_clearance_s = 9.0;

    std::array<double, 7> steps_s() const {
        return {major_green_s, major_yellow_s, major_clearance_s, protected_left_s,
                minor_green_s, minor_yellow_s, minor_clearance_s};
    }
    double cycle_s() const {
        double sum_s = 0.0;
        for (const double step_s : steps_s()) sum_s += step_s;
        return sum_s;
    }
};

struct StreetIntersection {
    std::string name;
    double x_m = 0.0;  // of the centre, to the east
    double y_m = 0.0;  // to the north
    double radius_m = 20.0;
    std::vector<StreetArm> arms = {};
    SevenSteps programme;
    double offset_s = 0.0;  // the green of the major street begins then, and a cycle before, ...
};

// Arms of two intersections on one line that face each other are the ends of one road; there the exits of the one are the lanes to
// the other.
struct StreetSettings {
    std::string name;
    double median_m = 0.0;        // between the two directions of streets from west to east
    double minor_median_m = 0.0;  // and from south to north
    double lane_width_m = 3.5;
    double turn_speed_mps = 7.0;
    double clearance_m = 2.0;  // between centre lines below which vehicles touch
    std::vector<StreetIntersection> intersections = {};

    double longest_green_s() const {
        double longest_s = 0.0;
        for (const StreetIntersection& node : intersections) {
            longest_s = std::max({longest_s, node.programme.major_green_s, node.programme.minor_green_s});
        }
        return longest_s;
    }
};

}  // namespace stopline
