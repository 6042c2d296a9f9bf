// Functions for laws of any shape, which are stored as a GapTable.
#pragma once

#include <span>
#include <string>

#include "spacing_laws/gap_policy.h"

namespace stopline {

// Returns why a table cannot be a desired gap; empty if it can. The gap must be the standstill gap at rest, must not
// fall with the speed, and must grow by at most 20 m per m/s, so that it has no jump.
std::string gap_shape_problem(const GapTable& table, double standstill_gap_m);

// Implements GapLaw::evaluate with GapPolicy::table.
void evaluate_gap_table(const GapPolicy& policy, std::span<const double> speed_mps, std::span<double> gap_m,
                        std::span<double> slope_s);

// Implements GapLaw::meso_gap with the car-following model that the policy names. The time gap of the model `time_gap`
// is the mean slope of the gap from rest to 50 km/h.
MesoGap shaped_meso_gap(const GapPolicy& policy);

}  // namespace stopline
