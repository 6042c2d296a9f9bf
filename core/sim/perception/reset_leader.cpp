#include "sim/perception/reset_leader.h"

#include "base/containers/index.h"
#include "sim/state/no_leader.h"
#include "sim/state/queries/gap.h"
#include "sim/state/state.h"

namespace stopline {

void reset_leader(VehicleArrays& v, int slot, const LaneBlock& block) {
    if (slot >= block.past_last()) return;
    const bool first = slot == block.first;
    v.record[at(slot)].leader_id = first ? -1 : v.id[at(slot - 1)];
    if (first) return;  // find_leaders_beyond_lanes() finds the leader of the first vehicle in the next step
    v.is_platoon_leader[at(slot)] = 0.0F;
    v.reset_radar(slot, net_gap_m(v, slot - 1, slot), v.speed_mps[at(slot)] - v.speed_mps[at(slot - 1)]);
}

void initialise_sensors(VehicleArrays& v, int slot, bool first) {
    const std::size_t i = at(slot);
    v.record[i].leader_id = first ? -1 : v.id[i - 1];
    const double gap_m = first ? kNoLeader_m : net_gap_m(v, i - 1, i);
    v.reset_radar(slot, gap_m, first ? 0.0 : v.speed_mps[i] - v.speed_mps[i - 1]);
    v.reset_v2v(slot);
    if (v.has_v2v_channel) v.v2v.reset(slot);
    if (v.has_platoon_limit) v.platoon.reset(slot);
}

}  // namespace stopline
