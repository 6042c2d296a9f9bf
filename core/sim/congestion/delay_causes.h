// Attribution of delay to causes (Section VI.A of the paper), in intervals of RulesPlan::watch_ticks.
//
// A stopped vehicle waits for one thing: its signal, its leader, room in its exit lane, a vehicle in a conflict area or
// a vehicle with priority. At a red signal it also waits for a vehicle stopped close ahead inside the intersection, or
// for the vehicle that held it at the last green, as long as that has not moved since. The chain from vehicle to
// vehicle ends at a signal, at a moving vehicle, or in a cycle, which is a gridlock. The delay of a vehicle is
// attributed to the cause that stops the first vehicle of its own queue; a queue that ends in a cycle is part of the
// gridlock.
#pragma once

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns true if delays are attributed in this step.
bool delay_watch_is_due(const Model& model, const State& state);

// Sizes the scratch memory of the watch.
void prepare_delay_watch(const Model& model, const State& state, DelayWatch& watch);

// Attributes the delay of all stopped vehicles. find_stopped_vehicles() and find_wait_reasons() must have run for all
// partitions.
void attribute_delays(const Model& model, const State& state, CongestionState& congestion);

// Runs all phases of delay attribution on one thread.
void watch_delays(const Model& model, State& state);

}  // namespace stopline
