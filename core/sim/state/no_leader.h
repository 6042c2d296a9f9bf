// The gap of a vehicle that has no leader.
#pragma once

namespace stopline {

// Position of a leader that does not exist, and the net gap to it, m.
inline constexpr double kNoLeader_m = 1e6;
// Longest net gap of a vehicle with a leader, m.
inline constexpr double kLongestGap_m = 1e5;

}  // namespace stopline
