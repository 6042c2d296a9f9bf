// What a user says of the traffic that enters. SI units.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace stopline {

struct SumoTraffic;  // sumo_routes.h

struct DemandSettings {
    // queue: `vehicles` a lane enter as soon as there is room, then none; saturated: inlets never run dry; rate: `inflow_1ps`
    // vehicles arrive an arm, shared by its lanes, and wait outside where there is no room
    std::string kind = "queue";
    int vehicles = 60;
    double inflow_1ps = 600.0 / 3600.0;
    // The same of streets from south to north, where the others are saturated; 0: saturated too.
    double cross_inflow_1ps = 0.0;
    std::vector<std::string> arms = {};  // where vehicles enter: how names of lanes begin; none: all entries
    double entry_speed_mps = 50.0 / 3.6;
    // Of the vehicles on lanes from which one can turn and go straight on.
    double right = 0.0;
    double left = 0.0;
    // The same of streets from south to north, where they are not alike.
    std::string cross_turns = "alike";  // alike | own
    double cross_right = 0.0;
    double cross_left = 0.0;
    std::string order = "balanced";  // of the turns: balanced | random
    // empty: an empty network; queued: the approaches are full of standing vehicles
    std::string start = "empty";
    std::shared_ptr<const SumoTraffic> sumo = {};  // of an imported network, in place of all else
};

}  // namespace stopline
