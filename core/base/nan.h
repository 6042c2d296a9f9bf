#pragma once

#include <limits>

namespace stopline {

// The value of a result that does not exist, for example of the mean travel time if no vehicle has left the area.
inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace stopline
