#include "sim/meso_dynamics.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>

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

// The first slot from `slot` on whose vehicle leads; several at a time.
int next_leader(const VehicleArrays& v, int slot, int stop) {
    for (; slot < stop; slot += 4) {
        std::array<std::uint64_t, 2> four{};
        std::memcpy(four.data(), &v.leads[at(slot)], sizeof four);
        if ((four[0] | four[1]) == 0) continue;
        while (v.leads[at(slot)] == 0.0F) ++slot;
        return slot;
    }
    return stop;
}

constexpr double kAlone_m = 1e5;  // a gap without predecessor is longer

// Leaders of platoons accelerate alike, whatever their policy, until following asks for less.
void lead(const Model& model, std::span<const LaneStep> lanes, const MesoGroup& g, VehicleArrays& v) {
    int first = 0;
    for (const LaneStep& lane : lanes) {
        for (int slot = next_leader(v, lane.begin, lane.stop); slot < lane.stop;
             slot = next_leader(v, slot + 1, lane.stop)) {
            const int k = first + slot - lane.begin;
            const double share = g.speed[k] > model.leader_until_mps ? model.leader_until_mps / g.speed[k] : 1.0;
            const double faster_mps = g.speed[k] + model.leader_mps2 * share * model.step_s;
            const double drive_mps = std::min(faster_mps, g.cap[k]);
            const double touch_mps = std::max(g.gap[k], 0.0) / model.step_s;
            const bool alone = g.gap[k] > kAlone_m;
            const double follows_mps =
                alone ? touch_mps : safe_speed_mps(model.krauss[at(g.policy[k])], g.gap[k], g.ahead[k], g.more[k]);
            const double safe_mps = std::min(follows_mps, touch_mps);
            g.next[k] = at_rest(std::min(safe_mps, drive_mps));
            // One that stands goes on leading until it moves.
            if (safe_mps < faster_mps && g.next[k] > 0.0) v.leads[at(slot)] = 0.0F;
        }
        first += lane.count();
    }
}

}  // namespace

double stopping_speed_mps(const Model& model, const VehicleArrays& v, int slot, double room_m) {
    const Krauss& krauss = model.krauss[at(v.policy[at(slot)])];
    const double b = std::min(krauss.deceleration_mps2, model.driver.stop.deceleration_mps2);
    const double hardest_mps2 = model.driver.cacc.deceleration_emergency_mps2;
    const double lowest_mps = v.speed_mps[at(slot)] - hardest_mps2 * model.step_s;
    return std::max(braking_speed_mps(b, krauss.reaction_s, std::max(room_m, 0.0), 0.0), lowest_mps);
}

double leading_speed_mps(const Model& model, double speed_mps, double limit_mps) {
    const double most_mps = model.leader_share * limit_mps;
    return std::min(speed_mps + model.approach_share * (most_mps - speed_mps), most_mps);
}

void step_meso(const Model& model, const LaneGroup& lanes, State& state, NetworkPart& part) {
    const MesoKernels& kernels = meso_kernels(model.scalar_kernels);
    VehicleArrays& v = state.vehicles;
    const MesoStreams streams{v.position_m.data(),       v.speed_mps.data(), v.length_m.data(),
                              v.end_speed_mps.data(),    v.id.data(),        v.policy.data(),
                              v.acceleration_mps2.data()};
    const MesoGroup group = part.meso_group.streams();
    const MesoStep step{model.step_s,
                        dawdle_key(model.seed),
                        static_cast<std::uint64_t>(state.tick),
                        model.driver.deceleration_mps2,
                        model.approach_share,
                        model.turn_share};
    part.violations.overlaps += kernels.gather(streams, lanes, step, group);
    evaluate_more(model, lanes.vehicles, group);
    const bool two = model.krauss.size() == 2;
    if (two) kernels.follow_two(model.krauss[0], model.krauss[1], step, group, lanes.vehicles);
    for (int k = 0; !two && k < static_cast<int>(model.krauss.size()); ++k) {
        const int only = model.krauss.size() == 1 ? -1 : k;
        kernels.follow(model.krauss[at(k)], step, group, lanes.vehicles, only);
    }
    if (model.leader_mps2 > 0.0) lead(model, lanes.lanes, group, v);
    kernels.scatter(streams, lanes.lanes, step, group);
}

}  // namespace stopline
