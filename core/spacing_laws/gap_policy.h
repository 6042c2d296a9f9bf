// Spacing laws: the desired net gap to the leader as a function of the own speed (H of Fig. 3 of the paper). The slope
// of the function is the local time gap. The controller of full dynamics works with a time gap where the slope is
// positive, and with a constant distance where it is 0.
//
// To add a law, write a file spacing_laws/<name>.cpp that defines a GapLaw, and register the law in gap_policy.cpp. The
// conformance tests and the error message for an unknown name then include the new law. A spacing policy is a law with
// values for its parameters; to add one, write YAML (data/policies).
#pragma once

#include <span>
#include <string>
#include <vector>

#include "driver/driver_settings.h"

namespace stopline {

struct GapLaw {
    const char* name;
    const char* meaning;  // description in lists for the user
    // Writes the desired gap [m] and its slope over speed [s] for each speed [m/s]. All spans must have the same
    // length.
    void (*evaluate)(const GapPolicySettings& settings, std::span<const double> speed_mps, std::span<double> gap_m,
                     std::span<double> slope_s);
};

// Returns all registered laws.
std::span<const GapLaw> gap_laws();

// Returns the law with this name. Throws InputError with a list of the known names if there is none.
const GapLaw& find_gap_law(const std::string& name);

std::vector<std::string> gap_law_names();

// Returns the desired gap [m] at one speed [m/s].
double equilibrium_gap_m(const GapPolicySettings& settings, double speed_mps);

}  // namespace stopline
