// The network as the engine sees it: lanes, the lanes that follow each, and routes over them. Generators and importers build
// it; it is constant afterwards. A stop line is the end of a lane that has a signal group.
#pragma once

#include <string>
#include <vector>

#include "network/network_settings.h"

namespace stopline {

struct Point {
    double x_m = 0.0;
    double y_m = 0.0;
};

struct Lane {
    std::string name;
    double length_m = 0.0;
    double limit_mps = 0.0;
    double gradient = 0.0;     // rise over run, positive uphill in driving direction
    int signal_group = -1;     // of the stop line at its end; -1: none
    std::vector<int> next;     // lanes that can follow; none: vehicles leave the network here
    std::vector<Point> shape;  // centre line
};

// A sequence of lanes from an entry to an exit.
struct Route {
    std::string name;
    std::vector<int> lanes;
};

struct LaneGraph {
    std::vector<Lane> lanes;
    std::vector<Route> routes;
    std::vector<int> entries;  // lanes where vehicles enter; route k starts at one of these
    int signal_groups = 0;
};

// Straight lanes side by side, each with a stop line (signal group 0) and the road behind it. Entry lane k is lane 2 k, its
// continuation lane 2 k + 1, its route k.
LaneGraph make_approach(const ApproachSettings& settings);

// Throws InputError where lanes, routes or signal groups do not fit together.
void check(const LaneGraph& graph);

}  // namespace stopline
