#include "sim/step/occupied_lanes.h"

#include "base/containers/index.h"

namespace stopline {

void find_occupied_lanes(const State& state, QueueState& queues, Partition& part) {
    for (IndexBuffer* list : {&part.occupied, &part.awake, &part.awake_approaches, &part.awake_connections}) {
        list->reset(part.lanes.size());
    }
    part.present = 0;
    part.occupied_candidates.retain_if([&](std::size_t index) {
        const int lane = part.lanes[index];
        const int count = state.blocks[at(lane)].count;
        if (count == 0) return false;
        part.present += count;
        part.occupied.push(lane);
        int& sleep_group = queues.sleeps_until_green[at(lane)];
        if (sleep_group >= 0 && state.signals.lights[at(sleep_group)] == Light::green) sleep_group = -1;
        const bool awake = sleep_group < 0;
        const LanePlan& plan = state.plan.lane(lane);
        part.awake.push_if(awake, lane);
        part.awake_approaches.push_if(awake && plan.signal_group >= 0, lane);
        part.awake_connections.push_if(awake && plan.origin >= 0, lane);
        return true;
    });
}

}  // namespace stopline
