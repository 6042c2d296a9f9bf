// Distribution of the turn shares of an approach over its lanes. All lanes carry the same traffic, and together they
// have the shares of the approach.
#pragma once

#include <array>
#include <vector>

namespace stopline {

using TurnShares = std::array<double, 3>;  // straight, right, left
using TurnsAllowed = std::array<bool, 3>;

// Returns the turn shares of the vehicles on each lane, from the left. `shares` are those of the approach; each turn
// with a share must be allowed on at least one lane.
//
// The method is iterative proportional fitting (Deming and Stephan, 1940) of a matrix over lanes and turns. Each of the
// n rows shall sum to 1/n, and each column to the share of its turn. The fit starts from equal entries for all allowed
// turns. If no such matrix exists, the rows of the fit are scaled to 1, and the shares of the approach are met only
// roughly. A lane that allows none of the turns with a share gets the shares of the approach: its vehicles must change
// lanes.
std::vector<TurnShares> turns_by_lane(const std::vector<TurnsAllowed>& allowed, const TurnShares& shares);

}  // namespace stopline
