// Departures in SUMO's route files: the attributes departLane, departPos and departSpeed, and their defaults.
#pragma once

#include <optional>
#include <string>

#include "demand/demand_plan.h"
#include "sumo_import/sumo_net.h"
#include "sumo_import/sumo_xml.h"

namespace stopline {

// The values that SUMO uses where a vehicle does not have the attribute. SUMO 1.27.0 changed them (change log of SUMO,
// ticket 16888): departLane from "first" to "best_prob", departSpeed from 0 to "avg". departPos is "base" in all
// versions.
struct SumoDepartureDefaults {
    Trip::DepartLane lane = Trip::DepartLane::best;
    Trip::DepartSpeed speed = Trip::DepartSpeed::mean;
    std::string reason;  // where the version comes from, for the user
};

// Returns the defaults of the version of SUMO that wrote the route file. If the route file names no version, the
// version that wrote the network counts. If neither file names a version, returns the defaults of SUMO 1.27.0.
SumoDepartureDefaults sumo_departure_defaults(const SumoXml& routes, const SumoNet& net);
// Describes the defaults for the user: "departLane="best_prob" departSpeed="avg" (...)".
std::string text_of(const SumoDepartureDefaults& defaults);

// Reads the departure of a vehicle, trip or flow element into `trip`. Returns true if the element lacks departLane or
// departSpeed, so that a default applies. Throws InputError with file and line if an attribute is invalid.
bool read_sumo_departure(const SumoXml& xml, pugi::xml_node node, const SumoDepartureDefaults& defaults,
                         SumoWarnings& warnings, Trip& trip);

}  // namespace stopline
