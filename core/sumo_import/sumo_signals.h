// Signal programmes of an imported network.
#pragma once

#include <vector>

#include "signals/phase_priority.h"
#include "signals/signal_plan.h"
#include "sumo_import/sumo_graph.h"

namespace stopline {

// Returns the signals. The first one consists of group 0, which is always green. The other signals have the order of
// SumoNet::signals. At time t of the run, the time since the start of the current cycle is (t - offset) modulo the
// cycle time. The letters G, g, s, o and O mean green, y and Y mean yellow, and all other letters mean red. Signals
// with a SumoController react to traffic.
SignalPlans make_sumo_signals(const SumoNetwork& network, double step_s);

// Returns the right of way of all pairs of connections for which it changes with the phases of their fixed-time signal.
std::vector<PhasePriority> make_sumo_phase_priorities(const SumoNetwork& network, double step_s);
// Returns the same for signals that react to traffic.
std::vector<PriorityByPhase> make_sumo_priorities_by_phase(const SumoNetwork& network);

}  // namespace stopline
