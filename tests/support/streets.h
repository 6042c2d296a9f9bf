// Streets for tests: two intersections 200 m apart, a major street with three lanes, minor streets with one lane.
#pragma once

#include <string>

#include "network/street_settings.h"

namespace stopline {

// Returns an intersection. Without `minor` it is a pedestrian light, which has legs in the west and east only.
inline StreetIntersection street_node(const std::string& name, double x_m, bool minor = true) {
    StreetIntersection node;
    node.name = name;
    node.x_m = x_m;
    for (const char* const from : {"west", "east"}) {
        StreetLeg leg;
        leg.from = from;
        leg.lanes = {{minor ? "straight+left" : "straight"}, {"straight"}, {minor ? "straight+right" : "straight"}};
        leg.exits = 3;
        if (minor) {
            leg.right_share = 0.12;
            leg.left_share = 0.08;
        }
        node.legs.push_back(leg);
    }
    for (const char* const from : {"south", "north"}) {
        if (!minor) break;
        StreetLeg leg;
        leg.from = from;
        leg.lanes = {{"straight+left+right"}};
        leg.exits = 1;
        leg.right_share = 0.16;
        leg.left_share = 0.09;
        node.legs.push_back(leg);
    }
    return node;
}

inline StreetSettings two_streets() {
    StreetSettings streets;
    streets.median_m = 4.0;
    streets.intersections = {street_node("first", 0.0), street_node("second", 200.0)};
    return streets;
}

// Returns two_streets() with protected left turns from pockets of 60 m at both major legs of the first intersection.
inline StreetSettings streets_with_pockets() {
    StreetSettings streets = two_streets();
    StreetIntersection& node = streets.intersections[0];
    for (std::size_t a = 0; a < 2; ++a)
        node.legs[a].lanes = {{"left", 60.0}, {"straight"}, {"straight"}, {"straight+right"}};
    node.programme = {22, 3, 8, 3, 11, 3, 10};
    return streets;
}

}  // namespace stopline
