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
// matrix exists the columns hold, and what is too much on a lane is spread over those that are not full: its vehicles have to change
// lanes. Every turn with a share must be allowed on some lane.
std::vector<TurnShares> turns_by_lane(const std::vector<TurnsAllowed>& allowed, const TurnShares& shares);

}  // namespace stopline
