// Where the front of a vehicle is in the plane.
#pragma once

#include <cstddef>

#include "sim/model.h"
#include "sim/state.h"

namespace stopline {

// Behind its stop line it is on its own path already, which shares that stretch with others.
inline Pose vehicle_place(const Model& model, const State& state, int lane, std::size_t slot) {
    const Lane& road = model.graph.lanes[static_cast<std::size_t>(lane)];
    const double position_m = state.vehicles.position_m[slot];
    const int next = state.vehicles.next_lane[slot];
    if (road.signal_group >= 0 && position_m > road.stop_line_m && next >= 0) {
        return place_along(model.graph.lanes[static_cast<std::size_t>(next)], position_m - road.stop_line_m);
    }
    return place_along(road, road.shape_start_m + position_m);
}

}  // namespace stopline
