// Platoons of limited length in the mesoscale mode. A platoon consists of consecutive vehicles whose model relays V2V
// start messages (FollowingModel::relays_starts()). It may extend across stop lines. The first vehicle beyond the limit
// leads a mini-platoon: it starts with the vehicles ahead of it, and keeps a time gap while it drives.
#pragma once

#include <cstddef>

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Decides once a second which vehicles of the partition lead a mini-platoon. Does nothing in all other steps.
void update_platoons(const Model& model, State& state, const Partition& part);

// Moves the time gaps of the leaders of mini-platoons towards their targets. Caps the speeds of these vehicles for this
// step, so that they keep their gaps. `block_size`: MesoKernels::size.
void keep_platoon_gaps(const Model& model, std::size_t block_size, VehicleArrays& vehicles, Partition& part);

}  // namespace stopline
