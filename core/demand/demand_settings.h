// The user's settings of the traffic that enters the network. SI units.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace stopline {

struct SumoTraffic;   // sumo_import/sumo_routes.h
struct TrafficTable;  // demand/traffic_table.h

// From a time on, the arrival rate is multiplied by a factor.
struct ProfilePoint {
    double from_s = 0.0;
    double inflow = 1.0;  // factor
};

struct DemandSettings {
    // - queue: `vehicles` vehicles enter on each entry lane as soon as there is room. Then no more vehicles enter.
    // - saturated: the backlog of every entry lane is endless.
    // - rate: `inflow_1ps` vehicles per second arrive on each leg, spread over its lanes. They form a backlog if there
    //   is no room.
    // - counts: the vehicles of a file with detector counts arrive.
    // - od: the vehicles of an origin-destination matrix arrive.
    std::string kind = "queue";
    int vehicles = 60;
    double inflow_1ps = 600.0 / 3600.0;
    std::string arrivals = "even";                   // process of arrivals: even | poisson | platooned
    double platoon_size = 5.0;                       // platooned: mean number of vehicles in a platoon
    double platoon_headway_s = 2.0;                  // platooned: headway within a platoon
    double scale = 1.0;                              // factor of all arrivals
    std::vector<ProfilePoint> profile;               // factor of `inflow_1ps` over time; empty: 1 at all times
    std::string profile_shape = "steps";             // steps | linear: shape of the factor between two points
    std::string counts;                              // file with detector counts
    std::string od;                                  // file with the origin-destination matrix
    std::shared_ptr<const TrafficTable> table = {};  // content of the file `counts` or `od`
    // Only for saturated demand: inflow of each leg in the south and north. 0: these legs are saturated, too.
    double cross_inflow_1ps = 0.0;
    std::vector<std::string> approaches = {};  // names of the approaches where vehicles enter; empty: all
    double entry_speed_mps = 50.0 / 3.6;
    // Shares of right and left turns, 0 .. 1. A share applies on each lane that allows the turn and another movement.
    double right_share = 0.0;
    double left_share = 0.0;
    // separate: the turn shares below apply to the legs in the south and north. same: the shares above apply to all
    // legs.
    std::string cross_turns = "same";  // same | separate
    double cross_right_share = 0.0;
    double cross_left_share = 0.0;
    std::string order = "balanced";                // order of the turns: balanced | random
    std::string start = "empty";                   // empty | queued: approaches full of stopped vehicles
    std::shared_ptr<const SumoTraffic> sumo = {};  // traffic of an imported network; it replaces all other fields
};

}  // namespace stopline
