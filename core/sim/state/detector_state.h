// Detectors and the vehicles upstream of them. Owner: sim/step/detectors.cpp; sim/state/lane_blocks.cpp updates the
// counts when vehicles enter or leave a lane.
#pragma once

#include <vector>

namespace stopline {

struct DetectorState {
    std::vector<std::vector<int>> on_lane;  // [lane] detectors
    std::vector<int> upstream;              // [detector] vehicles on its lane that have not passed it
};

}  // namespace stopline
