// Reading of times and flows in SUMO's route files.
#pragma once

#include <cstdint>
#include <vector>

#include "sumo_import/sumo_xml.h"

namespace stopline {

// Returns the time in an attribute (seconds, hh:mm:ss or d:hh:mm:ss), or `fallback_s` if there is no such attribute.
// Throws InputError if the value is negative or not a time.
double sumo_time_s(const SumoXml& xml, pugi::xml_node node, const char* attribute, double fallback_s);

// Returns those departure times of a flow that are before `until_s`. The flow element gives them by the attribute
// `number`, `period`, `vehsPerHour` (or `perHour`) or `probability`. With period="exp(RATE)" the headways are random
// and have an exponential distribution. `seed` is the seed of all random draws. Throws InputError with file and line if
// an attribute is invalid.
std::vector<double> sumo_departures(const SumoXml& xml, pugi::xml_node flow, double until_s, std::uint64_t seed);

}  // namespace stopline
