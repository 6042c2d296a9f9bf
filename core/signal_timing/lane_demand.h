// The demand of each approach lane of a grid or a single intersection, from the inlets and turn shares of the model.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "sim/state/model.h"

namespace stopline {

// The signal groups of an intersection without phases. Stage 0 serves the streets from west to east.
inline constexpr int kTimingStages = 2;
inline constexpr const char* kTimingStreets[kTimingStages] = {"west-east", "south-north"};

struct LaneDemand {
    std::string lane;  // name of the lane
    int stage = 0;     // 0 .. kTimingStages - 1
    int index = 0;     // place of the lane in its approach, from the left
    double flow_veh_h = 0.0;
    double left_share = 0.0;  // share of the vehicles of the lane that turn left, 0 .. 1
    double right_share = 0.0;
};

// Returns the demand of all approach lanes. On a lane between two intersections it follows from the routes that end
// there: the flow is the solution of the balance of all lanes. Vehicles do not change lanes in these networks.
std::vector<LaneDemand> lane_demands(const Model& model);

// Returns the stage and the place from the left of an approach lane, as in LaneDemand.
int stage_of_lane(const Lane& lane);
int index_of_lane(const Lane& lane);

}  // namespace stopline
