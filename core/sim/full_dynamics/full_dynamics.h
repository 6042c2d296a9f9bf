// A step of full dynamics has two parts. The driver requests an acceleration from the state at the beginning of the
// step. The vehicle answers with its powertrain and moves.
#pragma once

#include <span>
#include <vector>

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Tables of the model in single precision, as the kernels read them.
struct FullTables {
    DriverTablesOf<float> driver;
    std::vector<PowertrainTablesOf<float>> vehicles;  // [type]
};
FullTables full_tables(const Model& model);

// Moves the vehicles of a lane group by one step. The lanes may be in any order. `part.full_group` must have room for
// all vehicles of the group. `next`: LaneGroup::lines of the next group, which is prefetched meanwhile; empty: no
// prefetch.
void step_full(const Model& model, const FullTables& tables, const LaneGroup& lanes, std::span<const int> next,
               State& state, Partition& part);

}  // namespace stopline
