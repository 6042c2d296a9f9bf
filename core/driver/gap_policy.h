// Spacing policies: the desired net gap to the predecessor as a function of the own speed (H of Fig. 3). The slope of that
// function is the local time gap: it decides whether the controller works as constant time gap (slope > 0) or as
// constant distance gap (slope 0).
//
// A new law is one file, law_<name>.cpp, that defines a GapLaw, and one line in gap_policy.cpp. That line also enters it in
// its conformance tests and in the error message for an unknown name. A new parameter set is YAML (data/policies).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "driver/driver_settings.h"

namespace stopline {

struct GapLaw {
    const char* name;
    const char* meaning;
    // Writes desired gap [m] and its slope over speed [s] for each speed [m/s]; all spans have one length.
    void (*evaluate)(const GapPolicySettings& settings, std::span<const double> speed_mps, std::span<double> gap_m,
                     std::span<double> slope_s);
};

// All registered laws, in the order of the list.
std::span<const GapLaw> gap_laws();

// Throws InputError that lists the known names.
const GapLaw& find_gap_law(const std::string& name);

std::vector<std::string> gap_law_names();

// Gap at one speed, for equilibrium tests and figures.
double equilibrium_gap_m(const GapPolicySettings& settings, double speed_mps);

}  // namespace stopline
