// Spacing laws: the desired net gap to the leader as a function of the own speed (H of Fig. 3 of the paper). The slope
// of the function is the local time gap. Where the slope is positive, the controller of full dynamics keeps a time gap.
// Where the slope is 0, it keeps a constant distance.
//
// To add a law, write a file spacing_laws/<name>.cpp that defines a GapLaw, and add the law to the list in
// gap_laws.cpp. Its parameters are then fields in YAML files. The lists for the user, the error message for an unknown
// name and the tests of all laws include it. A spacing policy is a law with values for its parameters; to add one,
// write YAML (data/policies). With the laws `formula` and `table`, a gap of any shape needs no C++.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "driver/driver_settings.h"
#include "driver/following_model.h"

namespace stopline {

// A number that a policy gives in YAML for its law, in addition to the standstill gap.
struct LawParameter {
    const char* name;     // name of the field
    const char* unit;     // unit in the file; values in C++ are in SI units
    double min, max;      // allowed values, in `unit`
    const char* meaning;  // description in the list of fields
};
inline constexpr LawParameter kTimeGapParameter{"time_gap", "s", 0, 20,
                                                "time gap: growth of the net gap per m/s of speed"};
inline constexpr LawParameter kSwitchSpeedParameter{"switch_speed", "km/h", 0, 300,
                                                    "speed up to which the net gap stays the standstill gap"};

// A gap as a function of the speed, stored for speeds in equal steps. Between these speeds, the gap is interpolated
// linearly. Above the last speed, it continues with the last slope.
struct GapTable {
    static constexpr double kNodesPerMps = 50.0;
    static constexpr double kHighest_mps = 100.0;
    static constexpr std::size_t kNodes = static_cast<std::size_t>(kNodesPerMps * kHighest_mps) + 1;

    std::vector<double> gap_m;  // [node], empty or kNodes values; node k is for k / kNodesPerMps [m/s]

    void evaluate(std::span<const double> speed_mps, std::span<double> gap, std::span<double> slope_s) const;
};

struct GapLaw;

// A spacing policy, ready for use.
struct GapPolicy {
    GapPolicySettings settings;
    const GapLaw* law = nullptr;
    std::array<double, kMaxLawParameters> values{};  // the parameters in the order of GapLaw::parameters, SI units
    GapTable table;                                  // empty if the law needs none
    MesoGap meso;

    // Writes the desired gap [m] and its slope over speed [s] for each speed [m/s]. All spans must have the same
    // length.
    void evaluate(std::span<const double> speed_mps, std::span<double> gap_m, std::span<double> slope_s) const;
};

// An error in the settings of a policy: the YAML field and the text for the user.
struct LawProblem {
    std::string field;
    std::string message;
};

struct GapLaw {
    const char* name;
    const char* meaning;  // description in lists for the user
    std::span<const LawParameter> parameters;
    // See GapPolicy::evaluate().
    void (*evaluate)(const GapPolicy& policy, std::span<const double> speed_mps, std::span<double> gap_m,
                     std::span<double> slope_s);
    // Returns the gap of the policy for the mesoscale mode, with the car-following model that the law implies. A policy
    // can name another model (GapPolicySettings::mesoscale). A law whose gap can have any shape implies no model:
    // MesoGap::family is then empty, and the policy must name a model for mesoscale runs.
    MesoGap (*meso_gap)(const GapPolicy& policy);
    // Returns contradictions between settings, each of which is within its range. nullptr: no contradiction is
    // possible.
    std::vector<LawProblem> (*problems)(const GapPolicySettings& settings) = nullptr;
    // Makes GapPolicy::table. nullptr: the law needs no table.
    GapTable (*tabulate)(const GapPolicySettings& settings) = nullptr;
    // True: human drivers without radar and V2V (driver/human.h). False: automated vehicles.
    bool is_human = false;
};

// Returns all registered laws.
std::span<const GapLaw* const> gap_laws();
// Adds a law that is not part of the project, such as the law of a test. Call this function before the first policy is
// made or loaded, because the list of parameters is made then. The law must exist until the end of the program.
void register_gap_law(const GapLaw& law);

// Returns the law with this name. Throws InputError with a list of the known names if there is none.
const GapLaw& find_gap_law(const std::string& name);

std::vector<std::string> gap_law_names();

// Returns the parameters of all laws. A parameter that several laws have is listed once. The index of a parameter in
// this list is its index in GapPolicySettings::parameters.
const std::vector<LawParameter>& law_parameters();

// Returns the value of a parameter in SI units. Throws std::logic_error if no law has a parameter of this name.
double law_parameter(const GapPolicySettings& settings, std::string_view name);
void set_law_parameter(GapPolicySettings& settings, std::string_view name, double value);

// Makes a policy ready for use. The settings must have no problems. Throws InputError for an unknown law.
GapPolicy make_gap_policy(const GapPolicySettings& settings);

// Returns the desired gap [m] at one speed [m/s].
double equilibrium_gap_m(const GapPolicy& policy, double speed_mps);
double equilibrium_gap_m(const GapPolicySettings& settings, double speed_mps);

}  // namespace stopline
