// The four sides of a network, and the sides between which the traffic of a straight lane goes.
#pragma once

#include <array>
#include <string_view>

#include "network/lane_graph.h"

namespace stopline {

enum class Side : int { west = 0, south = 1, east = 2, north = 3 };
inline constexpr std::array<const char*, 4> kSideNames{"west", "south", "east", "north"};

// Returns the side with this name, which must be one of kSideNames.
Side side_named(std::string_view name);

// Return the side that the traffic of a straight lane comes from, and the side that it goes to.
Side comes_from(const Lane& lane);
Side goes_to(const Lane& lane);

}  // namespace stopline
