// Full dynamics: moves vehicles by one step. First the driver requests an acceleration, which is computed from the
// state at the beginning of the step. Then the powertrain responds to the request, and the vehicle moves.
#pragma once

#include <span>
#include <vector>

#include "sim/full_dynamics/receive_kernels.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Driver tables and vehicle tables of the model, converted to single precision for the kernels.
struct FullTables {
    std::vector<DriverTablesOf<float>> drivers;       // [driver], as Model::drivers
    std::vector<PowertrainTablesOf<float>> vehicles;  // [vehicle type]
    std::vector<ReceivePolicy> receive_policies;      // [policy] only with an active V2V channel
};
FullTables full_tables(const Model& model);

// Moves the vehicles of a lane group by one step. The lanes may be in any order. `part.full_group` must have room for
// all vehicles of the group. `next`: LaneGroup::prefetch_slots of the next group. The data in these slots are
// prefetched during the step. If the list is empty, nothing is prefetched.
void step_full(const Model& model, const FullTables& tables, const LaneGroup& lanes, std::span<const int> next,
               State& state, Partition& part);

}  // namespace stopline
