// What a user says of the network: the parameters of a generator. SI units.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "network/street_settings.h"

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

        bool allows(std::string_view movement) const { return movements.find(movement) != std::string::npos; }
    };
    std::vector<LaneMovements> lanes = {};  // of each arm, from the left
    double radius_m = 20.0;                 // centre to stop line
    double approach_length_m = 200.0;       // entry of the network to stop line
    double exit_length_m = 100.0;           // to the end of the network
    double lane_width_m = 3.5;
    double speed_limit_mps = 50.0 / 3.6;
    double turn_speed_mps = 7.0;  // 2.5 m/s2 lateral on a radius of 20 m (Section IV.A)
    double clearance_m = 2.0;     // between centre lines below which vehicles touch: a car's width and a little more
};

// Intersections, all alike, where `columns` streets from south to north cross `rows` streets from west to east.
struct GridSettings {
    int columns = 1;
    int rows = 1;
    double column_spacing_m = 276.5;  // between the centres of neighbours (Section VI)
    double row_spacing_m = 192.5;
    std::string shape = "rectangle";  // without_corners: three by three are then one and its four neighbours

    bool has_corners() const { return shape == "rectangle"; }
};

struct SumoNetwork;  // sumo_graph.h

struct NetworkSettings {
    std::string kind = "approach";
    ApproachSettings approach;
    IntersectionSettings intersection;
    GridSettings grid;
    StreetSettings streets;
    // Of the kind `sumo`: files as the user names them, and what they hold.
    std::string net = {};
    std::vector<std::string> routes = {};
    std::vector<std::string> additional = {};
    std::shared_ptr<const SumoNetwork> sumo = {};

    bool is_streets() const { return kind == "streets"; }
    bool is_sumo() const { return kind == "sumo"; }
    bool has_several() const { return kind == "grid" || is_streets() || is_sumo(); }
    bool has_intersections() const { return kind != "approach"; }
};

}  // namespace stopline
