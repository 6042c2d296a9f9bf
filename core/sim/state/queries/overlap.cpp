#include "sim/state/queries/overlap.h"

#include "base/containers/index.h"
#include "sim/state/events.h"
#include "sim/state/queries/gap.h"

namespace stopline {

std::int64_t count_overlaps(const VehicleArrays& v, std::span<const LaneStep> lanes) {
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

void record_first_overlap(const Model& model, const State& state, Partition& part) {
    const VehicleArrays& v = state.vehicles;
    for (const int lane : part.occupied) {
        const LaneBlock& block = state.blocks[at(lane)];
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            const auto i = at(slot);
            if (v.position_m[i] <= rear_m(v, i - 1)) continue;
            const int leader_id = slot > block.first ? v.id[i - 1] : v.record[i].leader_id;
            part.violations.record({model.time_s(state.tick + 1), Violation::Kind::overlap, lane, v.id[i], leader_id});
        }
    }
}

}  // namespace stopline
