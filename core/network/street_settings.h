// The user's description of streets: intersections with positions, lanes and signal programmes. SI units.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace stopline {

struct StreetLane {
    std::string movements;  // one or more of left, straight and right, joined by '+'
    double pocket_m = 0.0;  // turn pocket: its length up to the stop line; 0: the lane is as long as the approach
};

// One side of an intersection with its approach lanes and exit lanes.
struct StreetLeg {
    std::string from = "west";           // side of the intersection: west, south, east or north
    std::vector<StreetLane> lanes = {};  // approach lanes, from the left
    int exits = 0;                       // number of exit lanes
    double speed_limit_mps = 50.0 / 3.6;
    double right_share = 0.0;  // share of right turns, 0 .. 1
    double left_share = 0.0;   // share of left turns, 0 .. 1; the remaining vehicles go straight on
    // The next two members are used only for a leg that leads to the border of the network.
    double length_m = 300.0;       // from the border to the stop line
    double exit_length_m = 100.0;  // from the intersection to the border
};

// The durations of the seven steps of a signal programme (Table 3 of the paper). The major street leads from west to
// east, and the minor street from south to north.
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
    double x_m = 0.0;        // coordinate of the centre, increasing to the east
    double y_m = 0.0;        // coordinate of the centre, increasing to the north
    double radius_m = 20.0;  // from the centre to the stop lines
    std::vector<StreetLeg> legs = {};
    SevenSteps programme;
    // Time at which a green of the major street begins. The cycle repeats before and after this time.
    double offset_s = 0.0;
};

// If two legs of neighbouring intersections face each other on one line, a road joins the intersections. The exit lanes
// of one intersection on this road are the approach lanes of the other.
struct StreetSettings {
    std::string name;
    double median_m = 0.0;        // width of the median in streets from west to east
    double minor_median_m = 0.0;  // width of the median in streets from south to north
    double lane_width_m = 3.5;
    double turn_speed_mps = 7.0;
    double clearance_m = 2.0;  // vehicles can touch where the centre lines of their lanes are closer than this
    // Smallest distance between the paths, at the rear of the vehicle ahead, at which a vehicle passes a vehicle from
    // its own lane with another movement, such as a waiting left turner. 0: clearance_m.
    double passing_clearance_m = 0.0;
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
