// Attributes delay to causes (Section VI.A of Massow, Radusch and Shorten, 2021), once every RulesPlan::watch_ticks
// steps.
//
// A stopped vehicle waits for one thing: its signal, its leader, room in its exit lane, a vehicle in a conflict area, a
// vehicle with priority, or a gap in the adjacent lane. A vehicle for which a stopped vehicle waits is called the
// blocker of the stopped vehicle. A vehicle at a red signal can have a blocker as well: a vehicle that is stopped a
// short distance past the stop line. If there is no such vehicle, the blocker is the vehicle that blocked the waiting
// vehicle during the previous green, provided that this blocker has not moved since.
//
// The chain from blocker to blocker ends at a vehicle without a stopped blocker, or in a cycle of vehicles, which is a
// gridlock. The delay of a vehicle is attributed to the cause that stops the first vehicle of its queue. If the chain
// of a queue ends in a gridlock, the cause is the gridlock.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns true if delays are attributed in this step.
bool delay_watch_is_due(const Model& model, const State& state);

// Allocates the memory of the delay watch.
void prepare_delay_watch(const Model& model, DelayWatch& watch);

// Attributes the delay of all stopped vehicles. In this step, find_stopped_vehicles() and find_wait_reasons() must have
// run for all partitions before.
void attribute_delays(const Model& model, State& state);

// Attributes the delays on one thread: lists the stopped vehicles, finds their blockers, and calls attribute_delays().
void watch_delays(const Model& model, State& state);

}  // namespace stopline
