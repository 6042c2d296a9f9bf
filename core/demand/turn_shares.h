// Distribution of the turn shares of an approach over its lanes. All lanes carry equal traffic, and the turns of all
// lanes together have the shares of the approach.
#pragma once

#include <array>
#include <vector>

namespace stopline {

using TurnShares = std::array<double, 3>;  // straight, right, left
using TurnsAllowed = std::array<bool, 3>;

// Returns the turn shares of the vehicles on each lane, from the left. `shares` are the turn shares of the approach.
// Each turn with a share above 0 must be allowed on at least one lane.
//
// The method is iterative proportional fitting (Deming and Stephan, 1940). It fits a matrix with one row per lane and
// one column per turn. Each of the n rows must sum to 1/n, and each column to the share of its turn. The fit starts
// from equal entries for all allowed turns. Finally each row is scaled to the sum 1. If no matrix has all these sums,
// the shares of the approach are met only approximately. A lane that allows no turn with a share above 0 gets the
// shares of the approach, so its vehicles must change lanes.
std::vector<TurnShares> turns_by_lane(const std::vector<TurnsAllowed>& allowed, const TurnShares& shares);

}  // namespace stopline
