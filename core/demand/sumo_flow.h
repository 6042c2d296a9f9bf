// Times in SUMO's route files, and when the vehicles of a flow depart.
#pragma once

#include <cstdint>
#include <vector>

#include "network/sumo_xml.h"

namespace stopline {

// An attribute that says seconds, hh:mm:ss or d:hh:mm:ss. Refused where it is below 0 or no time.
double sumo_time_s(const SumoXml& xml, pugi::xml_node node, const char* attribute, double fallback_s);

// Of a flow, before `until_s`, by its number, period, vehsPerHour (perHour) or probability, or with exponential gaps where its period is
// exp(RATE). `seed`: of what is drawn. Throws InputError.
std::vector<double> sumo_departures(const SumoXml& xml, pugi::xml_node flow, double until_s, std::uint64_t seed);

}  // namespace stopline
