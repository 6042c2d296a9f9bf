// Reads the vehicles, trips, flows, types and routes of SUMO's route files as trips of a DemandPlan.
//
// Format: https://sumo.dlr.de/docs/Definition_of_Vehicles,_Vehicle_Types,_and_Routes.html. scenarios/SUMO.md lists
// the supported elements.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "demand/demand_plan.h"
#include "sumo_import/sumo_graph.h"
#include "sumo_import/sumo_types.h"

namespace stopline {

struct SumoTraffic {
    std::vector<Trip> trips;       // in the order of departure
    std::vector<Turn> turns;       // turns of all trips, one trip after the other; see Trip::first_turn
    std::vector<std::string> ids;  // [trip]
    // The different vehicle types of all trips, and the index of the type for each trip. Empty if the driving behaviour
    // of the types is not used.
    std::vector<SumoType> types;
    std::vector<int> type_of;  // [trip]
    SumoWarnings warnings;
    std::vector<std::string> notes;                     // choices of the import that the user should know
    std::uint64_t hash = 0;                             // hash of the text of all files
    std::int64_t elements = 0;                          // number of vehicle, trip and flow elements in the files
    std::optional<double> first_late_departure_s = {};  // earliest departure at or after the end of the run

    // Returns the length of the shortest vehicle.
    double shortest_vehicle_m() const;
};

struct SumoRouteFiles {
    std::vector<std::filesystem::path> additional;  // read before the route files; only traffic is read from them
    std::vector<std::filesystem::path> routes;
    bool uses_driving = false;  // true: read the driving behaviour of the vehicle types
};

// Reads the files one after the other. A file may use types and routes of the files before it. Vehicles that depart at
// `until_s` or later are omitted, and flows without an end last until `until_s`. `seed` is the seed of all random
// draws. Throws InputError with file and line if a file is invalid.
SumoTraffic read_sumo_routes(const SumoRouteFiles& files, const SumoNetwork& network, double until_s,
                             std::uint64_t seed);

}  // namespace stopline
