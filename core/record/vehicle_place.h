// Positions and directions of vehicles in plane coordinates.
#pragma once

#include <cstddef>

#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns position and direction of the front of a vehicle on `lane`. `slot` is the index of the vehicle in the arrays
// of the state. Beyond the stop line of the lane, the vehicle follows the shape of its connection.
inline Pose front_pose(const Model& model, const State& state, int lane, std::size_t slot) {
    const Lane& graph_lane = model.graph.lanes[static_cast<std::size_t>(lane)];
    const double position_m = state.vehicles.position_m[slot];
    const int next = state.vehicles.next_lane[slot];
    if (graph_lane.signal_group >= 0 && position_m > graph_lane.stop_line_m && next >= 0) {
        return pose_along(model.graph.lanes[static_cast<std::size_t>(next)], position_m - graph_lane.stop_line_m);
    }
    return pose_along(graph_lane, graph_lane.shape_start_m + position_m);
}

}  // namespace stopline
