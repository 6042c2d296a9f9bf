#include "sim/full_dynamics.h"

#include "base/units.h"
#include "vehicle/powertrain_step.h"

namespace stopline {

// Not in the unnamed namespace: the clones of a kernel need external names, and so do their arguments' types.
namespace kernel {

// Rows of a delay line at this tick: where the present sample is written and where the delayed ones are read.
struct Rows {
    std::size_t now, late, later;
    double late_share, later_share;
};
// Plain pointers to the arrays of one plan step, so that the compiler sees independent streams.
struct PlanStreams {
    const double *position, *speed, *acceleration, *lag, *length, *desired_gap, *slope;
    const float *standstill_gap, *end_speed;
    double* request;
    int* leads;
    float *gap_now, *closing_now, *tell_acceleration, *tell_request, *tell_lag;
    const float *gap_late, *gap_later, *closing_late, *closing_later;
    const float *heard_acceleration, *heard_request, *heard_lag;
    const float *earlier_acceleration, *earlier_request, *earlier_lag;
};

}  // namespace kernel

using kernel::PlanStreams;
using kernel::Rows;

namespace {

// A vehicle that stands and has no reason to start is held by its brake, as a hill holder does.
constexpr double kStanding_mps = 1e-3;
constexpr double kStart_mps2 = 0.01;
constexpr double kHold_mps2 = -0.3;
// A predecessor as slow as this, and not about to start, is an obstacle to stop behind.
constexpr double kObstacle_mps = 0.5;

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

namespace kernel {

STOPLINE_SIMD_CLONES void plan(const PlanStreams& streams, const DriverTables& d, const Rows& radar, const Rows& v2v,
                               const LaneStep& lane, double dt) {
    const PlanStreams s = streams;
    const CaccSettings c = d.cacc;
    const double most_up = c.jerk_up_mps3 * dt;
    const double most_down = c.jerk_down_mps3 * dt;
    STOPLINE_INDEPENDENT
    for (int i = lane.begin; i < lane.end; ++i) {
        const double speed = s.speed[i];
        const double acceleration = s.acceleration[i];
        const double before = s.request[i];

        // Measure and tell.
        s.gap_now[i] = static_cast<float>(s.position[i - 1] - s.length[i - 1] - s.position[i]);
        s.closing_now[i] = static_cast<float>(speed - s.speed[i - 1]);
        s.tell_acceleration[i] = static_cast<float>(acceleration);
        s.tell_request[i] = static_cast<float>(before);
        s.tell_lag[i] = static_cast<float>(s.lag[i]);

        // What is known of the predecessor now.
        PredecessorView p;
        p.gap_m = radar.late_share * static_cast<double>(s.gap_late[i]) +
                  radar.later_share * static_cast<double>(s.gap_later[i]);
        p.closing_mps = radar.late_share * static_cast<double>(s.closing_late[i]) +
                        radar.later_share * static_cast<double>(s.closing_later[i]);
        p.acceleration_mps2 = v2v.late_share * static_cast<double>(s.heard_acceleration[i - 1]) +
                              v2v.later_share * static_cast<double>(s.earlier_acceleration[i - 1]);
        p.request_mps2 = v2v.late_share * static_cast<double>(s.heard_request[i - 1]) +
                         v2v.later_share * static_cast<double>(s.earlier_request[i - 1]);
        p.lag_s = v2v.late_share * static_cast<double>(s.heard_lag[i - 1]) +
                  v2v.later_share * static_cast<double>(s.earlier_lag[i - 1]);

        // Drive freely.
        const double to_end_m = lane.length_m - s.position[i];
        const double as_leader = free_acceleration(d, speed, lane.limit_mps);
        const double slow_down = slow_down_acceleration(d, speed, static_cast<double>(s.end_speed[i]), to_end_m);
        // Follow.
        const double follow =
            follow_acceleration(c, acceleration, s.lag[i], before, s.desired_gap[i], s.slope[i], p, dt);
        const double emergency = emergency_acceleration(c, speed, p);
        // Stop: at the line, behind a standing predecessor.
        const double at_line =
            select(i == lane.stop_slot, stop_acceleration(d, speed, to_end_m - lane.stop_margin_m), 1e3);
        const double speed_p = speed - p.closing_mps;
        const bool obstacle = (speed_p < kObstacle_mps) & (p.request_mps2 <= 0.0);
        const double behind_m = p.gap_m - c.radar_delay_s * p.closing_mps - static_cast<double>(s.standstill_gap[i]);
        const double behind = select(obstacle, stop_acceleration(d, speed, behind_m), 1e3);

        // The smallest answer wins. A platoon leader becomes a follower when following asks for less than driving freely.
        const int leads = s.leads[i] & static_cast<int>(follow > as_leader);
        const double catch_up = catch_up_acceleration(d, speed, lane.limit_mps);
        const double drive = lesser(select(leads != 0, as_leader, catch_up), slow_down);
        const double smallest = lesser(lesser(lesser(drive, follow), emergency), lesser(at_line, behind));
        const double smooth = limited(smallest, before - most_down, before + most_up);
        const bool held = (speed <= kStanding_mps) & (smallest <= kStart_mps2);
        s.request[i] = select(held, 0.0, greater(smooth, -c.deceleration_emergency_mps2));
        s.leads[i] = leads;
    }
}

struct DriveStreams {
    double *position, *speed, *acceleration, *torque, *brake, *gear_time, *lag;
    const double* request;
    int* gear;
    const int* type;
};

namespace {

// `only` < 0: all vehicles are of this type.
STOPLINE_INLINE void drive_loop(const DriveStreams& streams, const PowertrainTables& t, const LaneStep& lane, double dt,
                                int only) {
    const DriveStreams s = streams;
    const double grade_N = t.mass_kg * kGravity_mps2 * lane.sine;
    STOPLINE_INDEPENDENT
    for (int i = lane.begin; i < lane.end; ++i) {
        const PowertrainState now{s.speed[i],     s.acceleration[i], s.torque[i], s.brake[i],
                                  s.gear_time[i], s.lag[i],          s.gear[i]};
        const bool held = (now.speed_mps <= kStanding_mps) & (s.request[i] <= kStart_mps2);
        const PowertrainState next = powertrain_step(t, now, select(held, kHold_mps2, s.request[i]), grade_N, dt);
        const bool mine = (only < 0) | (s.type[i] == only);
        const double moved_m = 0.5 * (now.speed_mps + next.speed_mps) * dt;
        s.position[i] = select(mine, s.position[i] + moved_m, s.position[i]);
        s.speed[i] = select(mine, next.speed_mps, now.speed_mps);
        s.acceleration[i] = select(mine, next.acceleration_mps2, now.acceleration_mps2);
        s.torque[i] = select(mine, next.torque_Nm, now.torque_Nm);
        s.brake[i] = select(mine, next.brake_N, now.brake_N);
        s.gear_time[i] = select(mine, next.gear_time_s, now.gear_time_s);
        s.lag[i] = select(mine, next.lag_s, now.lag_s);
        s.gear[i] = mine ? next.gear : now.gear;
    }
}

}  // namespace

STOPLINE_SIMD_CLONES void drive_one_type(const DriveStreams& streams, const PowertrainTables& t, const LaneStep& lane,
                                         double dt) {
    drive_loop(streams, t, lane, dt, -1);
}

STOPLINE_SIMD_CLONES void drive_of_type(const DriveStreams& streams, const PowertrainTables& t, const LaneStep& lane,
                                        double dt, int type) {
    drive_loop(streams, t, lane, dt, type);
}

}  // namespace kernel

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
    kernel::plan(plan_streams(state, radar, v2v), model.driver, radar, v2v, lane, model.step_s);
}

void drive_full(const Model& model, const LaneStep& lane, State& state) {
    VehicleArrays& v = state.vehicles;
    const kernel::DriveStreams streams{
        v.position_m.data(),  v.speed_mps.data(), v.acceleration_mps2.data(), v.torque_Nm.data(), v.brake_N.data(),
        v.gear_time_s.data(), v.lag_s.data(),     v.request_mps2.data(),      v.gear.data(),      v.type.data()};
    if (model.vehicles.size() == 1) {
        kernel::drive_one_type(streams, model.vehicles[0], lane, model.step_s);
        return;
    }
    for (std::size_t k = 0; k < model.vehicles.size(); ++k) {
        kernel::drive_of_type(streams, model.vehicles[k], lane, model.step_s, static_cast<int>(k));
    }
}

}  // namespace stopline
