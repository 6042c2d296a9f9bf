// Which share of the vehicles on each lane of an approach turns where, so that all lanes are as full as each other and the turns of the
// approach as a whole have their shares.
#pragma once

#include <array>
#include <vector>

namespace stopline {

using TurnShares = std::array<double, 3>;  // straight, right, left
using TurnsAllowed = std::array<bool, 3>;

// Shares of each lane's own vehicles, from the left. Found by iterative proportional fitting (Deming and Stephan, 1940) of the matrix
// lane x turn, whose rows are to sum to 1/n and whose columns to `shares`, from equal entries where a lane allows a turn. Where no such
// matrix exists each lane has the turns that it allows in the proportions of the fit, and the approach as a whole turns a little
// differently. On a lane that allows no turn that has a share vehicles have the approach's shares, and must change lanes. Every turn with a
// share must be allowed on some lane.
std::vector<TurnShares> turns_by_lane(const std::vector<TurnsAllowed>& allowed, const TurnShares& shares);

}  // namespace stopline
