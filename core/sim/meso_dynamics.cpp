#include "sim/meso_dynamics.h"

#include <algorithm>

#include "sim/meso_kernels.h"
#include "sim/phases.h"

namespace stopline {

namespace {

std::size_t at(int slot) { return static_cast<std::size_t>(slot); }

// What policies with a gap that grows above a switching speed add to their standstill gap.
void evaluate_more(const Model& model, int vehicles, const MesoGroup& g) {
    for (int k = 0; k < static_cast<int>(model.policies.size()); ++k) {
        const CompiledPolicy& policy = model.policies[at(k)];
        if (!model.krauss[at(k)].constant_distance || policy.settings.law == "constant_distance") continue;
        for (int i = 0; i < vehicles; ++i) {
            if (g.policy[i] != k) continue;
            double gap_m = 0.0;
            double slope_s = 0.0;
            policy.law->evaluate(policy.settings, {g.speed + i, 1}, {&gap_m, 1}, {&slope_s, 1});
            g.more[i] = gap_m - policy.settings.standstill_gap_m;
        }
    }
}

// Leaders of platoons accelerate alike, whatever their policy, until following asks for less.
void lead(const Model& model, std::span<const LaneStep> lanes, const MesoGroup& g, VehicleArrays& v) {
    int k = -1;
    for (const LaneStep& lane : lanes) {
        for (int slot = lane.begin; slot < lane.stop; ++slot) {
            ++k;
            if (v.leads[at(slot)] == 0.0F) continue;
            const double share = std::min(1.0, model.leader_until_mps / std::max(g.speed[k], 1e-3));
            const double faster_mps = g.speed[k] + model.leader_mps2 * share * model.step_s;
            const double drive_mps = std::min(faster_mps, g.cap[k]);
            const double touch_mps = std::max(g.gap[k], 0.0) / model.step_s;
            const double safe_mps =
                std::min(safe_speed_mps(model.krauss[at(g.policy[k])], g.gap[k], g.ahead[k], g.more[k]), touch_mps);
            g.next[k] = std::max(std::min(safe_mps, drive_mps), 0.0);
            if (safe_mps < faster_mps) v.leads[at(slot)] = 0.0F;
        }
    }
}

}  // namespace

double stopping_speed_mps(const Model& model, const VehicleArrays& v, int slot, double room_m) {
    Krauss krauss = model.krauss[at(v.policy[at(slot)])];
    krauss.deceleration_mps2 = std::min(krauss.deceleration_mps2, model.driver.stop.deceleration_mps2);
    const double hardest_mps2 = model.driver.cacc.deceleration_emergency_mps2;
    const double lowest_mps = v.speed_mps[at(slot)] - hardest_mps2 * model.step_s;
    return std::max(braking_speed_mps(krauss, std::max(room_m, 0.0), 0.0), lowest_mps);
}

void step_meso(const Model& model, std::span<const LaneStep> lanes, State& state) {
    const MesoKernels& kernels = meso_kernels(model.scalar_kernels);
    VehicleArrays& v = state.vehicles;
    const MesoStreams streams{v.position_m.data(),       v.speed_mps.data(), v.length_m.data(),
                              v.end_speed_mps.data(),    v.id.data(),        v.policy.data(),
                              v.acceleration_mps2.data()};
    const MesoGroup group = state.meso_group.streams();
    const MesoStep step{model.step_s,
                        dawdle_key(model.seed),
                        static_cast<std::uint64_t>(state.tick),
                        model.driver.deceleration_mps2,
                        model.approach_share,
                        model.turn_share};
    int vehicles = 0;
    for (const LaneStep& lane : lanes) vehicles += lane.count();
    kernels.gather(streams, lanes, step, group);
    evaluate_more(model, vehicles, group);
    for (int k = 0; k < static_cast<int>(model.krauss.size()); ++k) {
        const int only = model.krauss.size() == 1 ? -1 : k;
        kernels.follow(model.krauss[at(k)], step, group, vehicles, only);
    }
    if (model.leader_mps2 > 0.0) lead(model, lanes, group, v);
    kernels.scatter(streams, lanes, step, group);
    state.violations.overlaps += overlaps(v, lanes);
}

}  // namespace stopline
