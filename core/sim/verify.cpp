// Nobody is lost: holds after every step of every run.
#include "sim/phases.h"

namespace stopline {

void verify(State& state) {
    std::int64_t present = 0;
    for (const LaneBlock& block : state.blocks) present += block.count;
    state.violations.lost_vehicles = state.entered - state.left - present;
}

}  // namespace stopline
