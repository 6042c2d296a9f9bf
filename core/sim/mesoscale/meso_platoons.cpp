#include "sim/mesoscale/meso_platoons.h"

#include <algorithm>

#include "base/containers/index.h"
#include "base/speed_thresholds.h"
#include "sim/state/queries/desired_gap.h"
#include "sim/state/queries/gap.h"
#include "sim/state/queries/platoon_interval.h"
#include "v2v/fallback.h"
#include "v2v/platoon_place.h"

namespace stopline {

namespace {

// Returns true if platoon leaders have an acceleration of their own. Only then does the mesoscale model decide which
// vehicles are platoon leaders (VehicleArrays::is_platoon_leader).
bool has_own_acceleration(const Model& model) {
    return model.leader_mps2 > 0.0 || model.leader_profile.bins_per_mps > 0.0;
}

// Returns the next place of a vehicle whose policy forms platoons. `leader_id` is -1 if the vehicle has no leader.
PlatoonPlace next_place(const Model& model, const VehicleArrays& v, std::size_t i, int leader_id) {
    const PlatoonArrays& platoon = v.platoon;
    const bool led_mini_platoon = platoon.target_time_gap_s[i] > 0.0;
    const PlatoonPlace own{platoon.place[i], led_mini_platoon && leader_id == platoon.leader_id[i]};
    const int leader_place = platoon.place[i - 1];
    const auto follows = [&] {
        const double excess_m = net_gap_m(v, i - 1, i) - desired_gap_m(model, v.policy[i], v.speed_mps[i]);
        return is_close_enough(excess_m, own.vehicles_ahead > 0 || own.leads_mini_platoon);
    };
    const bool leads = has_own_acceleration(model) && v.is_platoon_leader[i] != 0.0F;
    const bool joins = leader_id >= 0 && leader_place != kNoPlatoon && !leads && follows();
    return next_platoon_place(own, joins, {leader_place, false}, v.speed_mps[i] == 0.0, model.v2v_plan.max_platoon);
}

// Returns the highest next speed of the leader of a mini-platoon in slot i. The law keeps the time gap T exactly:
//     gap = standstill gap + T v  holds if  T dv/dt = v_l - v - (dT/dt) v
// with the speed v_l of the vehicle ahead of the mini-platoon. An error e of the gap adds lambda e to the right side
// and decays with the rate lambda, as in the gap law of full dynamics. The law is solved for the speed at the end of
// the step, so T may be tiny.
double time_gap_speed_mps(const Model& model, const VehicleArrays& v, std::size_t i, const TimeGapOf<double>& gap) {
    const CaccSettings& cacc = model.driver_of(v.policy[i]).tables.cacc;
    const double dt = model.step_s;
    const double lambda_1ps = cacc.feedback_kp_1ps2 / cacc.feedback_kd_1ps;
    const double spare_m = net_gap_m(v, i - 1, i) - model.following[at(v.policy[i])].equilibrium_gap_m(0.0);
    const double leader_mps = std::max(v.speed_mps[i - 1] + static_cast<double>(v.acceleration_mps2[i - 1]) * dt, 0.0);
    const double next_mps = (gap.time_gap_s * v.speed_mps[i] + dt * (leader_mps + lambda_1ps * spare_m)) /
                            (gap.time_gap_s + dt * (1.0 + gap.rate + lambda_1ps * gap.time_gap_s));
    return std::max(next_mps, v.speed_mps[i] - cacc.deceleration_comfort_mps2 * dt);
}

}  // namespace

void update_platoons(const Model& model, State& state, const Partition& part) {
    if (!updates_platoons(model, state)) return;
    VehicleArrays& v = state.vehicles;
    PlatoonArrays& platoon = v.platoon;
    for (const int lane : part.occupied) {
        const LaneBlock& block = state.blocks[at(lane)];
        for (int slot = block.first; slot < block.past_last(); ++slot) {
            const std::size_t i = at(slot);
            if (!model.following[at(v.policy[i])].relays_starts()) {
                platoon.place[i] = kNoPlatoon;
                continue;
            }
            const int leader_id = slot == block.first ? v.record[i].leader_id : v.id[i - 1];
            const PlatoonPlace place = next_place(model, v, i, leader_id);
            platoon.place[i] = place.vehicles_ahead;
            platoon.leader_id[i] = leader_id;
            platoon.target_time_gap_s[i] = place.leads_mini_platoon ? model.v2v_plan.platoon_time_gap_s : 0.0;
            // A crawling vehicle keeps its standstill gap.
            if (v.speed_mps[i] < kCrawlingSpeed_mps) platoon.time_gap_s[i] = platoon.time_gap_rate[i] = 0.0;
        }
    }
}

// A crawling vehicle keeps its standstill gap, like the vehicles of a standing queue. So all vehicles of a queue start
// and close up in the same way.
void keep_platoon_gaps(const Model& model, std::size_t block_size, VehicleArrays& v, Partition& part) {
    PlatoonArrays& platoon = v.platoon;
    for (const int block : part.moving_blocks) {
        for (std::size_t i = at(block) * block_size; i < (at(block) + 1) * block_size; ++i) {
            if (platoon.target_time_gap_s[i] == 0.0 && platoon.time_gap_s[i] == 0.0) continue;
            if (v.id[i] < 0 || v.speed_mps[i] < kCrawlingSpeed_mps) continue;
            TimeGapOf<double> gap{platoon.time_gap_s[i], platoon.time_gap_rate[i]};
            update_time_gap<double>(gap, platoon.target_time_gap_s[i], v.speed_mps[i], model.step_s);
            platoon.time_gap_s[i] = gap.time_gap_s;
            platoon.time_gap_rate[i] = gap.rate;
            if (gap.time_gap_s <= 0.0) continue;
            v.speed_cap_mps[i] = std::min(v.speed_cap_mps[i], time_gap_speed_mps(model, v, i, gap));
            part.capped_slots.push_back(static_cast<int>(i));
        }
    }
}

}  // namespace stopline
