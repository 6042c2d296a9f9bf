// What holds after every step of every run: nobody overlaps its predecessor (on another lane: lane_heads.cpp), nobody is lost.
#include "sim/phases.h"

namespace stopline {

std::int64_t overlaps(const VehicleArrays& v, std::span<const LaneStep> lanes) {
    constexpr double kRounding_m = 1e-6;
    const double* const position = v.position_m.data();
    const float* const length = v.length_m.data();
    std::int64_t count = 0;
    for (const LaneStep& lane : lanes) {
        for (int i = lane.begin + 1; i < lane.stop; ++i) {
            const double gap_m = position[i - 1] - static_cast<double>(length[i - 1]) - position[i];
            count += gap_m < -kRounding_m ? 1 : 0;
        }
    }
    return count;
}

void verify(State& state) {
    std::int64_t present = state.limbo.count;
    for (const LaneBlock& block : state.blocks) present += block.count;
    state.violations.lost_vehicles = state.entered - state.left - present;
}

}  // namespace stopline
