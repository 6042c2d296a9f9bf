// The kernels' text. Included by one file for each instruction set, each in a namespace of its own.
#include <array>
#include <cstdint>
#include <initializer_list>

#include "base/simd_memory.h"
#include "base/units.h"
#include "sim/full_kernels.h"
#include "vehicle/powertrain_step.h"

namespace stopline {

namespace {

// A vehicle that stands and has no reason to start is held by its brake, as a hill holder does.
constexpr double kStanding_mps = 1e-3;
constexpr double kStart_mps2 = 0.01;
constexpr double kHold_mps2 = -0.3;
// A speed as small as this is what rounding leaves of standstill.
constexpr double kRest_mps = 1e-6;
// A predecessor as slow as this, and braking at least like this (or standing and not about to start), will stop: its place
// of rest is something to stop behind.
constexpr double kObstacle_mps = 5.0;
constexpr double kBraking_mps2 = 0.2;

// One sample of a delay line, between two rows where the delay is no multiple of the step.
template <class R>
STOPLINE_INLINE R delayed(const Rows& rows, const float* late, const float* later, int i) {
    const R sample = load<R>(late + i);
    return rows.later_share == 0.0 ? sample : rows.late_share * sample + rows.later_share * load<R>(later + i);
}

// The vehicle in slot i, or with R = Batch those in i .. i + 7.
template <class R>
STOPLINE_INLINE void plan_at(const PlanStreams& s, const DriverTablesOf<float>& d, const Rows& radar, const Rows& v2v,
                             const LaneStep& lane, double dt, int i) {
    const CaccSettingsOf<float>& c = d.cacc;
    const R speed = load<R>(s.speed + i);
    const R acceleration = load<R>(s.acceleration + i);
    const R lag = load<R>(s.lag + i);
    const R before = load<R>(s.request + i);

    // Measure.
    store(s.gap_now + i, load_difference<R>(s.position + i - 1, s.position + i) - load<R>(s.length + i - 1));
    store(s.closing_now + i, speed - load<R>(s.speed + i - 1));
    const R rate = 1.0 / lag;

    // What is known of the predecessor now.
    PredecessorView<R> p{};
    p.gap_m = delayed<R>(radar, s.gap_late, s.gap_later, i);
    p.closing_mps = delayed<R>(radar, s.closing_late, s.closing_later, i);
    p.acceleration_mps2 = delayed<R>(v2v, s.heard_acceleration, s.earlier_acceleration, i - 1);
    p.request_mps2 = delayed<R>(v2v, s.heard_request, s.earlier_request, i - 1);
    p.rate_1ps = delayed<R>(v2v, s.heard_rate, s.earlier_rate, i - 1);

    // Drive freely.
    const R nothing = splat<R>(1e3);  // an answer that never wins
    const R to_end_m = load_difference<R>(lane.turn_m, s.position + i);
    const R as_leader = free_acceleration(d, speed, lane.limit_mps);
    const R slow_down =
        lane.leads_to_lower_limit ? slow_down_acceleration(d, speed, load<R>(s.end_speed + i), to_end_m) : nothing;
    // Follow.
    const R follow = follow_acceleration(c, acceleration, lag, rate, before, load<R>(s.desired_gap + (i + lane.to_gap)),
                                         load<R>(s.slope + (i + lane.to_gap)), p, dt);
    const R emergency = emergency_acceleration(c, speed, p);
    // Stop: at the line, before a conflict area, behind a standing predecessor.
    const R from_stopper = counting_from<R>(i - lane.stop_slot);
    const R at_line = select(from_stopper == 0.0, splat<R>(lane.stop_slot < 0 ? 1e3 : lane.stop_mps2), nothing);
    R at_conflict = nothing;
    if (lane.hold_slot >= 0) {
        at_conflict = select(counting_from<R>(i - lane.hold_slot) == 0.0, splat<R>(lane.hold_mps2), nothing);
    }
    const R speed_p = greater(speed - p.closing_mps, 0.0);
    const R stopping_p = STOPLINE_FLAG(R, p.request_mps2 <= splat<R>(0.0) - lesser(speed_p, 1.0) * kBraking_mps2) *
                         STOPLINE_FLAG(R, speed_p < kObstacle_mps);
    R behind = nothing;
    if (any(stopping_p)) {
        const R behind_m =
            p.gap_m - c.radar_delay_s * p.closing_mps - load<R>(s.standstill_gap + i) + stopping_distance_m(d, speed_p);
        behind = choose(stopping_p, stop_acceleration(d, speed, behind_m), nothing);
    }

    // The smallest answer wins. A platoon leader becomes a follower when following asks for less than driving freely.
    const R leads = load<R>(s.leads + i) * STOPLINE_FLAG(R, follow > as_leader);
    const R drive = lesser(choose(leads, as_leader, catch_up_acceleration(d, speed, lane.limit_mps)), slow_down);
    const R smallest = lesser(lesser(lesser(drive, follow), emergency), lesser(lesser(at_line, at_conflict), behind));
    const R smooth = limited<R>(smallest, before - c.jerk_down_mps3 * dt, before + c.jerk_up_mps3 * dt);
    // A standing vehicle does not brake harder and harder: its next start begins from zero.
    const R lowest = select(speed <= kStanding_mps, splat<R>(0.0), splat<R>(-c.deceleration_emergency_mps2));
    const R request = greater(smooth, lowest);
    store(s.request + i, request);
    store(s.leads + i, leads);
    // Tell. The request is in force at the end of this step; the acceleration, a mean over the last one, is brought to
    // that time by the lag.
    const R reached = lesser(1.5 * dt * rate, 1.0);
    store(s.tell_request + i, request);
    store(s.tell_acceleration + i, acceleration + (request - acceleration) * reached);
    store(s.tell_rate + i, rate);
}

// The vehicle in slot i, or those in i .. i + 7, as far as they are of type `only` (< 0: all are).
template <class R>
STOPLINE_INLINE void drive_at(const DriveStreams& s, const PowertrainTablesOf<float>& t, double grade_N, double dt,
                              int only, int i) {
    PowertrainState<R> now{};
    now.speed_mps = load<R>(s.speed + i);
    now.acceleration_mps2 = load<R>(s.acceleration + i);
    now.torque_Nm = load<R>(s.torque + i);
    now.brake_N = load<R>(s.brake + i);
    now.gear_time_s = load<R>(s.gear_time + i);
    now.lag_s = load<R>(s.lag + i);
    now.gear = load<R>(s.gear + i);
    // The request moves within the step from the last one to the new one.
    const R request = load<R>(s.request + i);
    const R mean = 0.5 * (load<R>(s.request_before + i) + request);
    const R held = STOPLINE_FLAG(R, now.speed_mps <= kStanding_mps) * STOPLINE_FLAG(R, request <= kStart_mps2);
    const PowertrainState<R> next = powertrain_step<R>(t, now, choose(held, splat<R>(kHold_mps2), mean), grade_N, dt);
    const R mine = only < 0 ? splat<R>(1.0) : STOPLINE_FLAG(R, load<R>(s.type + i) == only);
    store(s.acceleration + i, choose(mine, next.acceleration_mps2, now.acceleration_mps2));
    store(s.torque + i, choose(mine, next.torque_Nm, now.torque_Nm));
    store(s.brake + i, choose(mine, next.brake_N, now.brake_N));
    store(s.gear_time + i, choose(mine, next.gear_time_s, now.gear_time_s));
    store(s.lag + i, choose(mine, next.lag_s, now.lag_s));
    store(s.gear + i, choose(mine, next.gear, now.gear));
}

// Fetches what the next lane's vehicles i, i + 1, ... will need while this lane's are computed: a lane's share of an array is
// too short for the processor to see a stream in it.
STOPLINE_INLINE void prefetch(const PlanStreams& s, int i) {
    for (const double* stream : {s.position, s.speed}) {
        __builtin_prefetch(stream + i);
        __builtin_prefetch(stream + i + kSimdWidth / 2);
    }
    const std::array<const float*, 15> streams{
        s.acceleration,       s.lag,           s.length,       s.request,           s.leads,        s.gap_now,
        s.gap_late,           s.closing_now,   s.closing_late, s.tell_acceleration, s.tell_request, s.tell_rate,
        s.heard_acceleration, s.heard_request, s.heard_rate};
    for (const float* stream : streams) __builtin_prefetch(stream + i);
}
STOPLINE_INLINE void prefetch(const DriveStreams& s, int i) {
    for (const float* stream : {s.torque, s.brake, s.gear_time, s.gear}) __builtin_prefetch(stream + i);
}

// Calls treat(number type, i) for a lane's vehicles: whole batches, and half a batch where no more are left.
template <class R, class Treat>
STOPLINE_INLINE void for_each_batch(const LaneStep& lane, Treat treat) {
    int i = lane.begin;
    if constexpr (kWidthOf<R> >= 16) {
        for (; i + kWidthOf<R> / 2 < lane.stop; i += kWidthOf<R>) treat(R(0.0), i);
        if (i < lane.stop) treat(Packed<kWidthOf<R> / 2>(0.0), i);
    } else {
        for (; i < lane.stop; i += kWidthOf<R>) treat(R(0.0), i);
    }
}

template <class R>
void plan(const PlanStreams& s, const DriverTablesOf<float>& d, const Rows& radar, const Rows& v2v,
          FullKernels::Lanes lanes, double dt) {
    for (const LaneStep& lane : lanes) {
        for_each_batch<R>(lane, [&](auto number, int i) STOPLINE_INLINE_LAMBDA {
            if (lane.to_next_lane != 0) prefetch(s, i + lane.to_next_lane);
            plan_at<decltype(number)>(s, d, radar, v2v, lane, dt, i);
        });
    }
}

template <class R>
void drive(const DriveStreams& s, const PowertrainTablesOf<float>& t, FullKernels::Lanes lanes, double dt, int only) {
    for (const LaneStep& lane : lanes) {
        const double grade_N = t.mass_kg * kGravity_mps2 * lane.sine;
        for_each_batch<R>(lane, [&](auto number, int i) STOPLINE_INLINE_LAMBDA {
            if (lane.to_next_lane != 0) prefetch(s, i + lane.to_next_lane);
            drive_at<decltype(number)>(s, t, grade_N, dt, only, i);
        });
    }
}

// Few operations on much memory: the compiler vectorises it by itself.
inline void integrate(double* __restrict position, double* __restrict speed, const float* __restrict acceleration,
                      FullKernels::Lanes lanes, double dt) {
    for (const LaneStep& lane : lanes) {
        for (int i = lane.begin; i < lane.stop; ++i) {
            const double before = speed[i];
            const double after = before + static_cast<double>(acceleration[i]) * dt;
            speed[i] = after > kRest_mps ? after : 0.0;
            position[i] += 0.5 * (before + speed[i]) * dt;
        }
    }
}

inline std::int64_t overlaps(const double* position, const float* length, FullKernels::Lanes lanes) {
    constexpr double kRounding_m = 1e-6;
    std::int64_t count = 0;
    for (const LaneStep& lane : lanes) {
        for (int i = lane.begin + 1; i < lane.stop; ++i) {
            const double gap_m = position[i - 1] - static_cast<double>(length[i - 1]) - position[i];
            count += gap_m < -kRounding_m ? 1 : 0;
        }
    }
    return count;
}

}  // namespace

}  // namespace stopline
