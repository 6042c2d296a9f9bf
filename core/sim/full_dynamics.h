// A step of the full-dynamics fidelity: plan (driver: what acceleration is asked for, from the state at the beginning of the step)
// and drive (vehicle: what the powertrain makes of it, and the new position).
#pragma once

#include <span>
#include <vector>

#include "sim/model.h"
#include "sim/state.h"

namespace stopline {

// The model's tables as the kernels read them: in single precision.
struct FullTables {
    DriverTablesOf<float> driver;
    std::vector<PowertrainTablesOf<float>> vehicles;  // [type]
};
FullTables full_tables(const Model& model);

// One step of the vehicles on some lanes, which the part's scratch must have room for; lanes in any order.
// `next`: LaneGroup::lines of the next group, which are fetched from memory meanwhile; empty: nothing is.
void step_full(const Model& model, const FullTables& tables, const LaneGroup& lanes, std::span<const int> next,
               State& state, NetworkPart& part);

}  // namespace stopline
