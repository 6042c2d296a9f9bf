// Contradictions in the settings of phases that run in rings.
#pragma once

#include <vector>

#include "signals/signal_controller.h"

namespace stopline {

// Returns the contradictions. Fields are those of SignalSettings::phases.
std::vector<SignalProblem> ring_problems(const SignalSettings& settings, int groups);

}  // namespace stopline
