// Traffic in SUMO's route files: vehicles, trips, flows, their types and routes, as trips of a DemandPlan.
//
// Read: https://sumo.dlr.de/docs/Definition_of_Vehicles,_Vehicle_Types,_and_Routes.html. What maps to what: scenarios/README.md.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "demand/demand_plan.h"
#include "network/sumo_graph.h"

namespace stopline {

struct SumoTraffic {
    std::vector<Trip> trips;       // by departure
    std::vector<Turn> turns;       // of all, see Trip::first_turn
    std::vector<std::string> ids;  // [trip]
    SumoWarnings warnings;
    std::uint64_t hash = 0;              // of the files
    std::int64_t elements = 0;           // vehicles, trips and flows in them
    std::optional<double> later_s = {};  // the first departure of those that come after the run

    double shortest_m() const;
};

struct SumoRouteFiles {
    std::vector<std::filesystem::path> additional;  // read first; elements that are no traffic are passed over
    std::vector<std::filesystem::path> routes;
};

// Reads the files in order; types and routes of one are known in the next. Those that depart at `until_s` or later are left out, and flows
// without an end go on until then. `seed`: of what is drawn. Throws InputError with file and line.
SumoTraffic read_sumo_routes(const SumoRouteFiles& files, const SumoNetwork& network, double until_s,
                             std::uint64_t seed);

}  // namespace stopline
