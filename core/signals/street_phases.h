// Phases of an intersection of streets, for controllers that react to traffic. They follow from the seven steps of its
// programme.
#pragma once

#include <vector>

#include "signals/signal_plan.h"

namespace stopline {

// Returns up to three phases: the major street, whose left-turn lanes have a permissive green, then the protected left
// turns of the major street, then the minor street. The names of movements are those of the signal groups: major, left
// and minor. The protected left turns are left out if their step lasts 0 s or if no lane is for left turns only. A
// street without approach lanes has a green for pedestrians, which is left out if it lasts 0 s.
//
// The maximum green of a phase is the green of its step. Yellow and all-red times are those of the steps, too. The
// steps have no yellow after the protected left turns, so this phase takes the times of the major street.
std::vector<PhaseSettings> make_street_phases(const StreetIntersection& intersection);

// Makes the plan of an intersection with the controller `actuated`. Its three groups are those of make_streets(). Lanes
// for left turns only call and extend the phase that protects them (SignalPlan::phases.rings.phases says which).
SignalPlan make_street_signal_plan(const SignalSettings& settings, const StreetIntersection& intersection,
                                   int first_group, double step_s);

}  // namespace stopline
