// The detectors on each lane and, for each detector, the number of vehicles on its lane that have not passed it yet.
// Owner: sim/step/detectors.cpp. sim/state/lane_blocks.cpp updates these numbers when vehicles enter or leave a lane.
#pragma once

#include <cstdint>
#include <vector>

#include "base/containers/packed_lists.h"

namespace stopline {

struct DetectorState {
    PackedLists<int> on_lane;   // [lane] indices of the detectors on the lane
    std::vector<int> upstream;  // [detector] number of vehicles on the detector's lane that are still upstream of it
    // [detector] tick at the end of the step in which a front passed the detector last; -1: never
    std::vector<std::int64_t> last_crossing_tick;
};

}  // namespace stopline
