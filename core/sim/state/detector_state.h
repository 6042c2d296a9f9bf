// The detectors on each lane, and the number of vehicles that have not passed each detector yet. Owner:
// sim/step/detectors.cpp. sim/state/lane_blocks.cpp updates the numbers when vehicles enter or leave a lane.
#pragma once

#include <vector>

namespace stopline {

struct DetectorState {
    std::vector<std::vector<int>> on_lane;  // [lane] indices of the detectors on the lane
    std::vector<int> upstream;  // [detector] number of vehicles on the detector's lane that are still upstream of it
};

}  // namespace stopline
