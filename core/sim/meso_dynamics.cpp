#include "sim/meso_dynamics.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "base/random.h"
#include "base/simd.h"
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int slot) { return static_cast<std::size_t>(slot); }

// What policies with a gap that grows above a switching speed add to their standstill gap.
MesoMore evaluate_more(const Model& model, std::size_t size, const VehicleArrays& v, NetworkPart& part) {
    const auto grows = [&](int k) {
        return model.krauss[at(k)].constant_distance && model.policies[at(k)].settings.law != "constant_distance";
    };
    constexpr std::size_t kLargest = kSimdWidth;
    part.more.clear();
    for (int k = 0; k < static_cast<int>(model.policies.size()); ++k) {
        if (!grows(k)) continue;
        const CompiledPolicy& policy = model.policies[at(k)];
        part.more.resize(part.blocks.size() * size, 0.0);
        double* more = part.more.data();
        for (const int block : part.blocks) {
            std::array<double, kLargest> gap_m{};
            std::array<double, kLargest> slope_s{};
            const std::size_t from = at(block) * size;
            policy.law->evaluate(policy.settings, {v.speed_mps.data() + from, size}, {gap_m.data(), size},
                                 {slope_s.data(), size});
            for (std::size_t j = 0; j < size; ++j, ++more) {
                if (v.policy[from + j] == k) *more = gap_m[j] - policy.settings.standstill_gap_m;
            }
        }
    }
    return part.more.empty() ? nullptr : part.more.data();
}

}  // namespace

double stopping_speed_mps(const Model& model, const VehicleArrays& v, int slot, double room_m) {
    const Krauss& krauss = model.krauss[model.krauss.size() == 1 ? 0 : at(v.policy[at(slot)])];
    const double b = std::min(krauss.deceleration_mps2, model.driver.stop.deceleration_mps2);
    const double hardest_mps2 = model.driver.cacc.deceleration_emergency_mps2;
    const double lowest_mps = v.speed_mps[at(slot)] - hardest_mps2 * model.step_s;
    return std::max(braking_speed_mps(b, krauss.reaction_s, std::max(room_m, 0.0), 0.0), lowest_mps);
}

double leading_speed_mps(const Model& model, double speed_mps, double limit_mps) {
    const double most_mps = model.leader_share * limit_mps;
    return std::min(speed_mps + model.approach_share * (most_mps - speed_mps), most_mps);
}

MesoStreams meso_streams(VehicleArrays& v) {
    return {v.position_m.data(),  v.speed_mps.data(), v.limit_mps.data(),     v.turn_m.data(),
            v.imposed_mps.data(), v.length_m.data(),  v.end_speed_mps.data(), v.acceleration_mps2.data(),
            v.leads.data(),       v.id.data(),        v.policy.data()};
}

MesoStep meso_step(const Model& model, std::int64_t tick, bool fetches) {
    constexpr double kAny_mps2 = 1e9;
    const bool relays = model.relayed > 0;
    const auto is_plain = [](const Krauss& k) { return k.transient_gap_s2 == 0.0; };
    return {model.step_s,
            dawdle_key(model.seed),
            static_cast<std::uint64_t>(tick),
            model.driver.deceleration_mps2,
            model.approach_share,
            model.turn_share,
            model.leader_mps2,
            model.leader_until_mps,
            model.leader_profile.bins_per_mps > 0.0 ? &model.leader_profile : nullptr,
            relays,
            relays && std::all_of(model.krauss.begin(), model.krauss.end(), is_plain),
            model.graph.approaches.empty() ? kAny_mps2 : model.driver.cacc.deceleration_emergency_mps2,
            fetches};
}

void step_meso(const Model& model, State& state, NetworkPart& part) {
    VehicleArrays& v = state.vehicles;
    const MesoKernels& kernels = meso_kernels(model.scalar_kernels);
    for (const ToldToStart& told : part.told) v.acceleration_mps2[at(told.slot)] = told.mps2;
    const MesoMore more = evaluate_more(model, static_cast<std::size_t>(kernels.size), v, part);
    const std::int64_t count = kernels.step(meso_streams(v), part.blocks, model.krauss, more,
                                            meso_step(model, state.tick, state.outgrows_cache()));
    if (count > 0) see_overlap(model, state, part);
    part.violations.overlaps += count;
    for (const int slot : part.imposed) v.imposed_mps[at(slot)] = kAnySpeed_mps;
    part.imposed.clear();
}

}  // namespace stopline
