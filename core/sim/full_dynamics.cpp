#include "sim/full_dynamics.h"

#include "base/narrowed.h"
#include "base/units.h"
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

// Desired gaps of a lane's slots, from the first on: each law runs over the whole span, its vehicles take its answer.
void evaluate_gap_laws(const Model& model, const LaneStep& lane, State& state) {
    const std::size_t n = at(lane.end - lane.begin);
    const auto first_n = [n](std::vector<double>& array) { return std::span<double>(array.data(), n); };
    const std::span<const double> speed(state.vehicles.speed_mps.data() + lane.begin, n);
    const auto evaluate = [&](const CompiledPolicy& policy, std::vector<double>& gap, std::vector<double>& slope) {
        policy.law->evaluate(policy.settings, speed, first_n(gap), first_n(slope));
    };
    evaluate(model.policies[0], state.desired_gap_m, state.gap_slope_s);
    const int* policy_of = state.vehicles.policy.data() + lane.begin;
    for (std::size_t k = 1; k < model.policies.size(); ++k) {
        evaluate(model.policies[k], state.law_gap_m, state.law_slope_s);
        for (std::size_t i = 0; i < n; ++i) {
            const bool mine = policy_of[i] == static_cast<int>(k);
            state.desired_gap_m[i] = mine ? state.law_gap_m[i] : state.desired_gap_m[i];
            state.gap_slope_s[i] = mine ? state.law_slope_s[i] : state.gap_slope_s[i];
        }
    }
}

}  // namespace

FullTables full_tables(const Model& model) {
    FullTables tables{narrowed(model.driver), {}};
    for (const PowertrainTables& type : model.vehicles) tables.vehicles.push_back(narrowed(type));
    return tables;
}

void plan_full(const Model& model, const FullTables& tables, const LaneStep& lane, State& state) {
    evaluate_gap_laws(model, lane, state);
    full_kernels(model.scalar_kernels)
        .plan(plan_streams(state), tables.driver, state.radar, state.v2v, lane, model.step_s);
}

void drive_full(const Model& model, const FullTables& tables, const LaneStep& lane, State& state) {
    VehicleArrays& v = state.vehicles;
    const DriveStreams streams{
        v.speed_mps.data(), v.acceleration_mps2.data(), v.torque_Nm.data(),
        v.brake_N.data(),   v.gear_time_s.data(),       v.lag_s.data(),
        v.gear.data(),      v.request_mps2.data(),      v.v2v_request_mps2.data() + state.v2v.before,
        v.type.data()};
    const FullKernels& kernels = full_kernels(model.scalar_kernels);
    for (std::size_t k = 0; k < model.vehicles.size(); ++k) {
        const double weight_N = model.vehicles[k].mass_kg * kGravity_mps2;
        const int only = model.vehicles.size() == 1 ? -1 : static_cast<int>(k);
        kernels.drive(streams, tables.vehicles[k], weight_N * lane.sine, lane, model.step_s, only);
    }
    kernels.integrate(v.position_m.data(), v.speed_mps.data(), v.acceleration_mps2.data(), lane, model.step_s);
    // Here, while the lane is in the cache; what is beyond its end is checked in verify.cpp.
    state.violations.overlaps += kernels.overlaps(v.position_m.data(), v.length_m.data(), lane.first, lane.stop);
}

}  // namespace stopline
