// Signal controllers: they decide which light each signal group of an intersection shows. One controller runs for each
// intersection, with lights and memory of its own.
//
// To add a controller, write a file signals/<name>.cpp that defines a SignalController, and add it to the list in
// signal_controllers.cpp. Its name is then a value of the field `signal.controller`, and its parameters are fields of
// the section `signal`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "signals/signal_plan.h"
#include "signals/signal_settings.h"
#include "signals/signal_state.h"

namespace stopline {

// A number that a scenario gives for a controller, in addition to the times of SignalSettings.
struct SignalParameter {
    const char* name;      // name of the field
    const char* unit;      // unit in the file; values in C++ are in SI units
    double min, max;       // allowed values, in `unit`
    const char* fallback;  // default as text with its unit, such as "3 s"
    const char* meaning;   // description in the list of fields
};

// An error in the settings of a signal: the field of the section `signal`, and the text for the user.
struct SignalProblem {
    std::string field;
    std::string message;
};

struct SignalController {
    const char* name;
    const char* meaning;  // description in lists for the user
    std::span<const SignalParameter> parameters;
    // Returns the nominal cycle of a signal with this number of groups.
    NominalCycle (*nominal_cycle)(const SignalSettings& settings, int groups);
    // Sets the lights and the memory at tick 0. Returns the tick at which step() is called first.
    std::int64_t (*init)(SignalView& view);
    // Sets the lights of the tick view.tick(). Returns the tick at which step() is called next, view.tick() + 1 or
    // later.
    std::int64_t (*step)(SignalView& view);
    // Announces greens (the SPaT messages of an intersection). Returns the first green of a group that ends after
    // `after_tick`, as far as the controller knows it at the present tick. The green may last longer than announced,
    // but not shorter. nullptr: the controller announces nothing.
    GreenWindow (*next_green)(const SignalView& view, int group, std::int64_t after_tick) = nullptr;
    // Returns how many numbers the controller keeps in SignalView::memory(). They are 0 before init(). nullptr: none.
    std::size_t (*memory_size)(const SignalPlan& plan) = nullptr;
    // Returns the distances from the stop line at which each approach lane gets a detector for the controller, m.
    // Every approach lane also has a detector at the stop line. nullptr: no further detectors.
    std::vector<double> (*detectors_m)(const SignalSettings& settings) = nullptr;
    // Returns the distance from the stop line within which platoons announce their arrival by V2V, m; 0: the controller
    // does not hear them. nullptr: it never does.
    double (*platoon_range_m)(const SignalPlan& plan) = nullptr;
    // Returns contradictions between settings, each of which is within its range. nullptr: no contradiction is
    // possible.
    std::vector<SignalProblem> (*problems)(const SignalSettings& settings, int groups) = nullptr;
    // True: the lights follow SignalPlan::programmes, whatever the traffic does. The controller then sees no detectors,
    // and the state hash leaves its lights and memory out.
    bool follows_programme = false;
    // True: the controller can run phases (SignalPlan::phases).
    bool runs_phases = false;
    // True: the controller runs the phases in rings (PhasePlan::rings). SignalState::phase is then the index of a pair
    // of phases in RingPlan::pairs.
    bool runs_rings = false;
};

// Returns all registered controllers.
std::span<const SignalController* const> signal_controllers();
std::vector<std::string> signal_controller_names();
// Adds a controller that is not part of the project, such as the controller of a test. Call this function before the
// first scenario is loaded, because the list of fields is made then. The controller must exist until the end of the
// program.
void register_signal_controller(const SignalController& controller);

// Returns the controller with this name. Throws InputError with a list of the known names if there is none.
const SignalController& find_signal_controller(std::string_view name);

// Returns the parameters of all controllers. A parameter that several controllers have is listed once. The index of a
// parameter in this list is its index in SignalSettings::parameters.
std::vector<SignalParameter> signal_parameters();
// Returns the value of a parameter in SI units. Throws std::logic_error if no controller has a parameter of this name.
double signal_parameter(const SignalSettings& settings, std::string_view name);

// Returns the nominal cycle of a signal with the controller that the settings name.
NominalCycle nominal_cycle(const SignalSettings& settings, int groups);

}  // namespace stopline
