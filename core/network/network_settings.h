// The user's settings of the network: the parameters of the generators, or the files of an imported network. SI units.
#pragma once

#include <any>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "network/street_settings.h"

namespace stopline {

// One straight road with a stop line.
struct ApproachSettings {
    int lanes = 1;
    double length_m = 700.0;       // from the entry to the stop line
    double exit_length_m = 700.0;  // from the stop line to the end of the network
    double speed_limit_mps = 50.0 / 3.6;
    double gradient = 0.0;  // slope as height over distance; positive: uphill in driving direction
};

// An intersection of four equal legs at right angles.
struct IntersectionSettings {
    struct LaneMovements {
        std::string movements;  // one or more of left, straight and right, joined by '+'

        bool allows(std::string_view movement) const { return movements.find(movement) != std::string::npos; }
    };
    std::vector<LaneMovements> lanes = {};  // the approach lanes, equal on all legs, from the left
    double radius_m = 20.0;                 // from the centre to the stop line
    double approach_length_m = 200.0;       // from the entry of the network to the stop line
    double exit_length_m = 100.0;           // from the intersection to the end of the network
    double lane_width_m = 3.5;
    double speed_limit_mps = 50.0 / 3.6;
    double turn_speed_mps = 7.0;  // gives 2.5 m/s2 lateral acceleration at a radius of 20 m (the paper, Section IV.A)
    // Vehicles can touch where the centre lines of their lanes are closer than this. The default is slightly more than
    // the width of a car.
    double clearance_m = 2.0;
};

// A grid of equal intersections, where `columns` streets from south to north cross `rows` streets from west to east.
struct GridSettings {
    int columns = 1;
    int rows = 1;
    double column_spacing_m = 276.5;  // between the centres of intersections in a row (the paper, Section VI)
    double row_spacing_m = 192.5;     // between the centres of intersections in a column
    std::string shape = "rectangle";  // rectangle | without_corners: no intersections in the four corners

    bool has_corners() const { return shape == "rectangle"; }
};

struct SumoNetwork;  // sumo_import/sumo_graph.h

struct NetworkSettings {
    std::string kind = "approach";  // name of a NetworkKind (scenario/kinds)
    ApproachSettings approach;
    IntersectionSettings intersection;
    GridSettings grid;
    StreetSettings streets;
    // For the kind `sumo`: the paths of the files as the user wrote them, and the network that was read from the files.
    std::string net = {};
    std::vector<std::string> routes = {};
    std::vector<std::string> additional = {};
    std::string vehicles = "from_scenario";  // source of the driving behaviour: from_scenario | from_routes
    std::shared_ptr<const SumoNetwork> sumo = {};
    // Settings of a kind that has no member above. See own_settings().
    std::any own = {};
};

// Returns the settings that only the kind of the network knows. S is their type. Settings that have not been set yet
// have the defaults of S.
template <class S>
S& own_settings(NetworkSettings& network) {
    if (std::any_cast<S>(&network.own) == nullptr) network.own = S{};
    return *std::any_cast<S>(&network.own);
}
template <class S>
const S& own_settings(const NetworkSettings& network) {
    static const S kDefaults{};
    const S* const own = std::any_cast<S>(&network.own);
    return own == nullptr ? kDefaults : *own;
}

}  // namespace stopline
