#include "network/side.h"

#include <algorithm>
#include <cmath>

#include "base/containers/index.h"

namespace stopline {

namespace {

// Returns the direction of the lane: 0 east, 1 north, 2 west, 3 south.
int heading(const Lane& lane) {
    const Point from = lane.shape.front();
    const Point to = lane.shape.back();
    const double x_m = to.x_m - from.x_m;
    const double y_m = to.y_m - from.y_m;
    if (std::abs(x_m) >= std::abs(y_m)) return x_m >= 0.0 ? 0 : 2;
    return y_m >= 0.0 ? 1 : 3;
}

// [result of heading()] side that the traffic of a lane comes from.
constexpr std::array<Side, 4> kOrigin{Side::west, Side::south, Side::east, Side::north};

}  // namespace

Side comes_from(const Lane& lane) { return kOrigin[at(heading(lane))]; }
Side goes_to(const Lane& lane) { return kOrigin[at((heading(lane) + 2) % 4)]; }

Side side_named(std::string_view name) {
    const auto found = std::find(kSideNames.begin(), kSideNames.end(), name);
    return static_cast<Side>(found - kSideNames.begin());
}

}  // namespace stopline
