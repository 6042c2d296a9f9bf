#include "sim/full_dynamics.h"

#include <algorithm>

#include "base/narrowed.h"
#include "sim/full_kernels.h"

namespace stopline {

namespace {

std::size_t at(int slot) { return static_cast<std::size_t>(slot); }

PlanStreams plan_streams(State& state) {
    VehicleArrays& v = state.vehicles;
    const Rows& radar = state.radar;
    const Rows& v2v = state.v2v;
    PlanStreams s{};
    s.position = v.position_m.data();
    s.speed = v.speed_mps.data();
    s.acceleration = v.acceleration_mps2.data();
    s.lag = v.lag_s.data();
    s.length = v.length_m.data();
    s.desired_gap = state.desired_gap_m.data();
    s.slope = state.gap_slope_s.data();
    s.standstill_gap = v.standstill_gap_m.data();
    s.end_speed = v.end_speed_mps.data();
    s.request = v.request_mps2.data();
    s.leads = v.leads.data();
    s.gap_now = v.radar_gap_m.data() + radar.now;
    s.gap_late = v.radar_gap_m.data() + radar.late;
    s.gap_later = v.radar_gap_m.data() + radar.later;
    s.closing_now = v.radar_closing_mps.data() + radar.now;
    s.closing_late = v.radar_closing_mps.data() + radar.late;
    s.closing_later = v.radar_closing_mps.data() + radar.later;
    s.tell_acceleration = v.v2v_acceleration_mps2.data() + v2v.now;
    s.tell_request = v.v2v_request_mps2.data() + v2v.now;
    s.tell_rate = v.v2v_rate_1ps.data() + v2v.now;
    s.heard_acceleration = v.v2v_acceleration_mps2.data() + v2v.late;
    s.heard_request = v.v2v_request_mps2.data() + v2v.late;
    s.heard_rate = v.v2v_rate_1ps.data() + v2v.late;
    s.earlier_acceleration = v.v2v_acceleration_mps2.data() + v2v.later;
    s.earlier_request = v.v2v_request_mps2.data() + v2v.later;
    s.earlier_rate = v.v2v_rate_1ps.data() + v2v.later;
    return s;
}

DriveStreams drive_streams(State& state) {
    VehicleArrays& v = state.vehicles;
    return {v.speed_mps.data(), v.acceleration_mps2.data(), v.torque_Nm.data(),
            v.brake_N.data(),   v.gear_time_s.data(),       v.lag_s.data(),
            v.gear.data(),      v.request_mps2.data(),      v.v2v_request_mps2.data() + state.v2v.before,
            v.type.data()};
}

// Desired gaps of a lane's vehicles: each law runs over the whole lane, its vehicles take its answer.
void evaluate_gap_laws(const Model& model, const LaneStep& lane, State& state) {
    const std::size_t n = at(lane.stop - lane.begin);
    const std::size_t from = at(lane.begin + lane.to_gap);
    const std::span<const double> speed(state.vehicles.speed_mps.data() + lane.begin, n);
    double* const gap_m = state.desired_gap_m.data() + from;
    double* const slope_s = state.gap_slope_s.data() + from;
    const int* const policy_of = state.vehicles.policy.data() + lane.begin;
    const int first = policy_of[0];
    const auto evaluate = [&](int policy, double* gap, double* slope) {
        const CompiledPolicy& p = model.policies[at(policy)];
        p.law->evaluate(p.settings, speed, {gap, n}, {slope, n});
    };
    evaluate(first, gap_m, slope_s);
    for (int k = 0; k < static_cast<int>(model.policies.size()); ++k) {
        if (k == first || std::find(policy_of, policy_of + n, k) == policy_of + n) continue;
        evaluate(k, state.law_gap_m.data(), state.law_slope_s.data());
        for (std::size_t i = 0; i < n; ++i) {
            gap_m[i] = policy_of[i] == k ? state.law_gap_m[i] : gap_m[i];
            slope_s[i] = policy_of[i] == k ? state.law_slope_s[i] : slope_s[i];
        }
    }
}

}  // namespace

FullTables full_tables(const Model& model) {
    FullTables tables{narrowed(model.driver), {}};
    for (const PowertrainTables& type : model.vehicles) tables.vehicles.push_back(narrowed(type));
    return tables;
}

void step_full(const Model& model, const FullTables& tables, std::span<const LaneStep> lanes, State& state) {
    const FullKernels& kernels = full_kernels(model.scalar_kernels);
    VehicleArrays& v = state.vehicles;
    for (const LaneStep& lane : lanes) evaluate_gap_laws(model, lane, state);
    kernels.plan(plan_streams(state), tables.driver, state.radar, state.v2v, lanes, model.step_s);
    const DriveStreams streams = drive_streams(state);
    for (std::size_t k = 0; k < tables.vehicles.size(); ++k) {
        const int only = tables.vehicles.size() == 1 ? -1 : static_cast<int>(k);
        kernels.drive(streams, tables.vehicles[k], lanes, model.step_s, only);
    }
    kernels.integrate(v.position_m.data(), v.speed_mps.data(), v.acceleration_mps2.data(), lanes, model.step_s);
    // Here, while the lanes are in the cache; what is beyond a lane's end is checked in lane_heads.cpp.
    state.violations.overlaps += kernels.overlaps(v.position_m.data(), v.length_m.data(), lanes);
}

}  // namespace stopline
