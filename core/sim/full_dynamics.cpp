#include "sim/full_dynamics.h"

#include "base/units.h"
#include "sim/full_kernels.h"

namespace stopline {

namespace {

std::size_t at(int slot) { return static_cast<std::size_t>(slot); }

Rows rows_at(const DelayLine& line, std::int64_t tick, int slots) {
    const auto row = [&](std::int64_t age) {
        const std::int64_t wrapped = ((tick - age) % line.rows + line.rows) % line.rows;
        return static_cast<std::size_t>(wrapped) * static_cast<std::size_t>(slots);
    };
    return {row(0), row(line.steps), row(line.steps + 1), 1.0 - line.share, line.share};
}

PlanStreams plan_streams(State& state, const Rows& radar, const Rows& v2v) {
    VehicleArrays& v = state.vehicles;
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
    s.tell_lag = v.v2v_lag_s.data() + v2v.now;
    s.heard_acceleration = v.v2v_acceleration_mps2.data() + v2v.late;
    s.heard_request = v.v2v_request_mps2.data() + v2v.late;
    s.heard_lag = v.v2v_lag_s.data() + v2v.late;
    s.earlier_acceleration = v.v2v_acceleration_mps2.data() + v2v.later;
    s.earlier_request = v.v2v_request_mps2.data() + v2v.later;
    s.earlier_lag = v.v2v_lag_s.data() + v2v.later;
    return s;
}

}  // namespace

namespace {

// Desired gaps of all slots of a lane: each law runs over the whole span, its vehicles take its answer.
void evaluate_gap_laws(const Model& model, const LaneStep& lane, State& state) {
    const auto n = at(lane.end - lane.begin);
    const auto span_of = [&](std::vector<double>& array) {
        return std::span<double>(array).subspan(at(lane.begin), n);
    };
    const std::span<const double> speed = span_of(state.vehicles.speed_mps);
    if (model.policies.size() == 1) {
        model.policies[0].law->evaluate(model.policies[0].settings, speed, span_of(state.desired_gap_m),
                                        span_of(state.gap_slope_s));
        return;
    }
    for (std::size_t k = 0; k < model.policies.size(); ++k) {
        const CompiledPolicy& policy = model.policies[k];
        policy.law->evaluate(policy.settings, speed, span_of(state.law_gap_m), span_of(state.law_slope_s));
        for (std::size_t i = at(lane.begin); i < at(lane.end); ++i) {
            const bool mine = state.vehicles.policy[i] == static_cast<int>(k);
            state.desired_gap_m[i] = mine ? state.law_gap_m[i] : state.desired_gap_m[i];
            state.gap_slope_s[i] = mine ? state.law_slope_s[i] : state.gap_slope_s[i];
        }
    }
}

}  // namespace

void plan_full(const Model& model, const LaneStep& lane, State& state) {
    evaluate_gap_laws(model, lane, state);
    const Rows radar = rows_at(model.radar, state.tick, state.vehicles.slots);
    const Rows v2v = rows_at(model.v2v, state.tick, state.vehicles.slots);
    full_kernels(model.scalar_kernels)
        .plan(plan_streams(state, radar, v2v), model.driver, radar, v2v, lane, model.step_s);
}

void drive_full(const Model& model, const LaneStep& lane, State& state) {
    VehicleArrays& v = state.vehicles;
    const DriveStreams streams{v.position_m.data(), v.speed_mps.data(), v.acceleration_mps2.data(),
                               v.torque_Nm.data(),  v.brake_N.data(),   v.gear_time_s.data(),
                               v.lag_s.data(),      v.gear.data(),      v.request_mps2.data(),
                               v.type.data()};
    const FullKernels& kernels = full_kernels(model.scalar_kernels);
    for (std::size_t k = 0; k < model.vehicles.size(); ++k) {
        const PowertrainTables& type = model.vehicles[k];
        const int only = model.vehicles.size() == 1 ? -1 : static_cast<int>(k);
        kernels.drive(streams, type, type.mass_kg * kGravity_mps2 * lane.sine, lane, model.step_s, only);
    }
}

}  // namespace stopline
