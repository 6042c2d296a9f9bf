// Controllers that react to traffic, made from tlLogic elements of the types `actuated` and `NEMA`.
//
// Sources: https://sumo.dlr.de/docs/Simulation/Traffic_Lights.html and https://sumo.dlr.de/docs/Simulation/NEMA.html.
#pragma once

#include <string>
#include <vector>

#include "signals/signal_plan.h"
#include "signals/signal_settings.h"
#include "sumo_import/sumo_graph.h"
#include "sumo_import/sumo_right_of_way.h"

namespace stopline {

struct SumoController {
    SignalSettings settings;          // controller, times, rings; the phases have no movements
    std::vector<std::string> states;  // [phase] SUMO's letters
    // [phase of the signal, or pair of phases in two rings] index in SumoSignal::phases, which has its right of way
    std::vector<int> sumo_phases;
    double cycle_start_s = 0.0;  // coordination: start of a background cycle
    std::vector<LaneDetector> detectors;
    std::vector<SumoPhase> file_phases;  // phases of the file
};

// Sets SumoSignal::controller of all signals of the types `actuated` and `NEMA` that can run as such. The phases of
// `NEMA` become all pairs of phases that can run together. Warns of all that is not supported.
void set_sumo_controllers(SumoNet& net);
// The same for one signal.
void set_actuated_controller(SumoSignal& signal, SumoWarnings& warnings);
void set_nema_controller(SumoSignal& signal, SumoWarnings& warnings);

// Places the detectors of all controllers. The lanes of all connections must be in the graph already.
void place_sumo_detectors(SumoNetwork& network, const std::vector<BuiltConnection>& connections);

// Warns of parameters of a signal whose names do not begin with one of `known`.
void note_unknown_parameters(const SumoSignal& signal, const std::vector<std::string>& known, SumoWarnings& warnings);
// Returns a parameter of a signal, or `fallback`. Throws InputError if the value is not a number of at least 0.
double sumo_parameter(const SumoSignal& signal, const std::string& name, double fallback);

}  // namespace stopline
