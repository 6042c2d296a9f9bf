#include "sim/mesoscale/meso_dynamics.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "base/containers/index.h"
#include "base/random.h"
#include "base/simd/simd.h"
#include "sim/mesoscale/meso_platoons.h"
#include "sim/state/queries/overlap.h"
#include "sim/state/queries/stopping_distance.h"

namespace stopline {

namespace {

// Returns one value for each slot of the moving blocks: the extra gap in m of the vehicle's policy at its present speed
// (MesoGap). Returns nullptr if no policy has an extra gap.
ExtraGap evaluate_extra_gap(const Model& model, std::size_t size, const VehicleArrays& v, Partition& part) {
    constexpr std::size_t kMaxBlockSize = kSimdWidth;
    part.extra_gap_m.clear();
    for (int k = 0; k < static_cast<int>(model.policies.size()); ++k) {
        const GapPolicy& policy = model.policies[at(k)];
        if (!policy.meso.has_extra_gap) continue;
        part.extra_gap_m.resize(part.moving_blocks.size() * size, 0.0);
        double* extra_gap = part.extra_gap_m.data();
        for (const int block : part.moving_blocks) {
            std::array<double, kMaxBlockSize> gap_m{};
            std::array<double, kMaxBlockSize> slope_s{};
            const std::size_t from = at(block) * size;
            policy.evaluate({v.speed_mps.data() + from, size}, {gap_m.data(), size}, {slope_s.data(), size});
            for (std::size_t j = 0; j < size; ++j, ++extra_gap) {
                if (v.policy[from + j] == k) *extra_gap = gap_m[j] - policy.meso.gap_m(v.speed_mps[from + j]);
            }
        }
    }
    return part.extra_gap_m.empty() ? nullptr : part.extra_gap_m.data();
}

}  // namespace

double stopping_speed_mps(const Model& model, const VehicleArrays& v, int slot, double room_m) {
    const int policy = v.policy[at(slot)];
    const FollowingBraking braking = stop_line_braking(model, policy);
    const double max_braking_mps2 = model.driver_of(policy).tables.cacc.deceleration_emergency_mps2;
    const double lowest_mps = v.speed_mps[at(slot)] - max_braking_mps2 * model.step_s;
    return std::max(braking_speed_mps(braking.deceleration_mps2, braking.reaction_s, std::max(room_m, 0.0), 0.0),
                    lowest_mps);
}

double leading_speed_mps(const Model& model, int policy, double speed_mps, double limit_mps) {
    const double target_mps = model.leader_speed_share * limit_mps;
    if (speed_mps > target_mps)
        return std::max(target_mps, speed_mps - model.driver_of(policy).tables.deceleration_mps2 * model.step_s);
    return std::min(speed_mps + model.approach_share * (target_mps - speed_mps), target_mps);
}

MesoStreams meso_streams(VehicleArrays& v) {
    return {.position = v.position_m.data(),
            .speed = v.speed_mps.data(),
            .limit = v.limit_mps.data(),
            .next_limit = v.next_limit_m.data(),
            .speed_cap = v.speed_cap_mps.data(),
            .length = v.length_m.data(),
            .end_speed = v.end_speed_mps.data(),
            .acceleration = v.acceleration_mps2.data(),
            .is_platoon_leader = v.is_platoon_leader.data(),
            .id = v.id.data(),
            .policy = v.policy.data(),
            .start_ticks = v.has_human_drivers ? v.start_ticks.data() : nullptr};
}

MesoStep meso_step(const Model& model, std::int64_t tick, bool prefetches) {
    constexpr double kNoLimit_mps2 = 1e9;
    const DriverTables& driver = model.common_driver();
    const double emergency_mps2 = driver.cacc.deceleration_emergency_mps2;
    const bool relays = model.start_relay_vehicles > 0;
    const bool leaders_use_following_speed =
        relays && std::all_of(model.following.begin(), model.following.end(),
                              [](const FollowingModel& following) { return following.leader_uses_following_speed(); });
    // The car-following models ask for more than an emergency braking only after lane changes. In networks without lane
    // changes, which have no approaches, they therefore apply without a limit.
    const double hardest_mps2 = model.graph.approaches.empty() ? kNoLimit_mps2 : emergency_mps2;
    return {.dt = model.step_s,
            .key = dawdle_key(model.seed),
            .driver_key = driver_key(model.seed),
            .tick = static_cast<std::uint64_t>(tick),
            .slow_down_mps2 = driver.deceleration_mps2,
            .slow_downs_mps2 = model.slow_downs_mps2.empty() ? nullptr : model.slow_downs_mps2.data(),
            .approach_share = model.approach_share,
            .turn_share = model.turn_share,
            .leader_mps2 = model.leader_mps2,
            .leader_constant_power_speed_mps = model.leader_constant_power_speed_mps,
            .leader_profile = model.leader_profile.bins_per_mps > 0.0 ? &model.leader_profile : nullptr,
            .power_profile = model.has_fast_lanes ? &model.power_profile : nullptr,
            .calibrated_limit_mps = model.calibrated_limit_mps,
            .acceleration_limits = model.acceleration_limits.empty() ? nullptr : model.acceleration_limits.data(),
            .relays = relays,
            .leaders_use_following_speed = leaders_use_following_speed,
            .hardest_mps2 = hardest_mps2,
            .emergency_mps2 = emergency_mps2,
            .prefetches = prefetches};
}

void step_meso(const Model& model, State& state, Partition& part) {
    VehicleArrays& v = state.vehicles;
    for (const StartMessage& message : part.start_messages)
        v.acceleration_mps2[at(message.slot)] = message.acceleration_mps2;
    const std::size_t block_size = at(meso_block_size(model.scalar_kernels));
    if (v.has_platoon_limit) {
        update_platoons(model, state, part);
        keep_platoon_gaps(model, block_size, v, part);
    }
    const ExtraGap extra_gap = evaluate_extra_gap(model, block_size, v, part);
    const std::int64_t count = step_blocks(model.scalar_kernels, meso_streams(v), part.moving_blocks, model.following,
                                           extra_gap, meso_step(model, state.tick, state.outgrows_cache()));
    if (count > 0) record_first_overlap(model, state, part);
    part.violations.overlaps += count;
    for (const int slot : part.capped_slots) v.speed_cap_mps[at(slot)] = kUnlimitedSpeed_mps;
    part.capped_slots.clear();
}

}  // namespace stopline
