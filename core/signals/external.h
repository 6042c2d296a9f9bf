// The controller `external`: a program that steps the simulation chooses the phases.
#pragma once

#include "signals/signal_state.h"

namespace stopline {

// Asks a signal with the controller `external` for a phase (index in PhasePlan::phases). The present green ends when
// its minimum is over, then yellow and red follow, then the phase. A later request replaces an earlier one. Throws
// std::invalid_argument if the signal has another controller or no such phase.
void request_phase(const SignalPlan& plan, std::size_t signal, int phase, SignalState& signals);

}  // namespace stopline
