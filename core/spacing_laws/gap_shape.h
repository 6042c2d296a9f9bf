// Functions for laws whose gap can have any shape. Such a gap is stored as a GapTable.
#pragma once

#include <span>
#include <string>

#include "spacing_laws/gap_policy.h"

namespace stopline {

// Returns the reason why a table is no valid desired gap; empty if it is valid. The gap must be the standstill gap at
// rest and must not fall with the speed. It must not jump, which means that it grows by at most 20 m per m/s.
std::string gap_shape_problem(const GapTable& table, double standstill_gap_m);

// Implements GapLaw::evaluate with GapPolicy::table.
void evaluate_gap_table(const GapPolicy& policy, std::span<const double> speed_mps, std::span<double> gap_m,
                        std::span<double> slope_s);

// Implements GapLaw::meso_gap for laws that imply no car-following model. The time gap is the mean slope of the gap
// from rest to 50 km/h.
MesoGap shaped_meso_gap(const GapPolicy& policy);

}  // namespace stopline
