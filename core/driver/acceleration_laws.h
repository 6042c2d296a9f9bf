// The driver's three questions - drive freely, follow, stop - each answered by a desired acceleration; the smallest answer
// wins (combine). Pure functions without branches, over double or Batch (base/simd.h); the loops over vehicles are in
// sim/full_dynamics.cpp.
//
// Following is the cascade of Fig. 3: PD feedback on the gap measured by radar, feedforward of what the predecessor says of
// itself over V2V. In the time domain, with gap error e = gap - d(v) and H = 1 + h s:
//     CTG  (h > 0):  h du/dt = -u + kp e + kd de/dt + a_p + (tau / tau_p) (u_p - a_p)
//     CDG  (h = 0):        u =      kp e + kd de/dt + predicted(...)
// (Ploeg et al. 2011, reference [31]; the ratio of lags inverts the own lag and applies the predecessor's, since
// (u_p - a_p) / tau_p is the predecessor's jerk.)
#pragma once

#include <array>

#include <type_traits>

#include "base/arithmetic.h"
#include "driver/driver_settings.h"

namespace stopline {

// Settings compiled for the kernel.
template <class Number>
struct DriverTablesOf {
    static constexpr int kProfileNodes = 32;
    CaccSettingsOf<Number> cacc;
    StopSettingsOf<Number> stop;
    Number speed_gain_1ps = 0.0;
    Number deceleration_mps2 = 0.0;  // for a lower limit ahead
    Number profile_nodes_per_mps = 0.0;
    std::array<Number, kProfileNodes> profile_mps2{};  // acceleration asked for, over speed
};
using DriverTables = DriverTablesOf<double>;

// Throws InputError where the profile is unusable.
DriverTables compile_driver(const DriverSettings& settings);

// What a vehicle knows of its predecessor.
template <class R>
struct PredecessorView {
    R gap_m;              // net gap by radar, delayed
    R closing_mps;        // own speed minus the predecessor's by radar, delayed
    R acceleration_mps2;  // by V2V, delayed
    R request_mps2;       // u of the predecessor, by V2V, delayed
    R rate_1ps;           // 1 / tau of the predecessor, by V2V, delayed
};

// Free driving of a platoon leader: the calibrated start-up profile towards the desired speed.
template <class R, class Number>
STOPLINE_INLINE R free_acceleration(const DriverTablesOf<Number>& d, const R& speed_mps,
                                    const std::type_identity_t<R>& desired_mps) {
    const R profile = on_grid(d.profile_mps2, R(speed_mps * d.profile_nodes_per_mps));
    return lesser(profile, d.speed_gain_1ps * (desired_mps - speed_mps));
}

// A follower may use more than the leader's profile, and a little more speed, to close its gap.
template <class R, class Number>
STOPLINE_INLINE R catch_up_acceleration(const DriverTablesOf<Number>& d, const R& speed_mps,
                                        const std::type_identity_t<R>& desired_mps) {
    const R towards_limit = d.speed_gain_1ps * (desired_mps * d.cacc.catch_up_factor - speed_mps);
    return lesser(towards_limit, d.cacc.acceleration_max_mps2);
}

// Slowing down for a lower limit `distance_m` ahead: along v^2 = v_end^2 + 2 b distance.
template <class R, class Number>
STOPLINE_INLINE R slow_down_acceleration(const DriverTablesOf<Number>& d, const R& speed_mps, const R& end_mps,
                                         const R& distance_m) {
    const double b = d.deceleration_mps2;
    const R allowed_mps = square_root(square(end_mps) + 2.0 * b * greater(distance_m, 0.0));
    return (allowed_mps - speed_mps) - b * speed_mps / greater(allowed_mps, 1.0);
}

// Stopping within `distance_m`: along the speed from which braking with b after the time tau stops there,
// v_p = -b tau + sqrt((b tau)^2 + 2 b distance) (the safe speed of Krauss 1998 for a standing obstacle), which lands
// without overshoot. The braking that keeps to the curve is b v / (v_p + b tau).
//
// Both numbers are our choice: tau leaves time for the lag of the brake (0.2 s) and for the command to change; the gain takes
// the vehicle back to the curve within 1 / gain = 0.7 s, slower than the brake answers, so that it does not swing.
inline constexpr double kLandingTime_s = 0.5;

template <class R, class Number>
STOPLINE_INLINE R stop_acceleration(const DriverTablesOf<Number>& d, const R& speed_mps, const R& distance_m) {
    constexpr double kSpeedGain_1ps = 1.5;
    const double b = d.stop.deceleration_mps2;
    const double bt = b * kLandingTime_s;
    const R curve_mps = square_root(square(bt) + 2.0 * b * greater(distance_m, 0.0)) - bt;
    const R late = select(distance_m > 0.0, splat<R>(0.0), splat<R>(-b));
    return late + kSpeedGain_1ps * (curve_mps - speed_mps) - b * speed_mps / (curve_mps + bt);
}

// The same for a fixed place that becomes known late: where the curve is out of reach, braking evenly with what is needed.
inline double stop_at_line_mps2(const DriverTables& d, double speed_mps, double distance_m) {
    const double needed_mps2 = 0.5 * square(speed_mps) / greater(distance_m, 0.1);
    const double on_curve_mps2 = stop_acceleration(d, speed_mps, distance_m);
    return needed_mps2 > d.stop.deceleration_mps2 ? lesser(on_curve_mps2, -needed_mps2) : on_curve_mps2;
}

// The distance in which that curve stops a vehicle: v^2 / (2 b) + v tau.
template <class R, class Number>
STOPLINE_INLINE R stopping_distance_m(const DriverTablesOf<Number>& d, const R& speed_mps) {
    return speed_mps * (speed_mps * (0.5 / d.stop.deceleration_mps2) + kLandingTime_s);
}

// Stopping behind the place of rest of a predecessor that will stop: one as slow as this, and braking at least like this (or
// standing and not about to start). 1e3 (no limit): it goes on.
inline constexpr double kObstacle_mps = 5.0;
inline constexpr double kObstacleBraking_mps2 = 0.2;

template <class R, class Number>
STOPLINE_INLINE R stop_behind_acceleration(const DriverTablesOf<Number>& d, const R& speed_mps,
                                           const R& standstill_gap_m, const PredecessorView<R>& p) {
    const R speed_p = greater(speed_mps - p.closing_mps, 0.0);
    const R stopping_p =
        STOPLINE_FLAG(R, p.request_mps2 <= splat<R>(0.0) - lesser(speed_p, 1.0) * kObstacleBraking_mps2) *
        STOPLINE_FLAG(R, speed_p < kObstacle_mps);
    const R none = splat<R>(1e3);
    if (!any(stopping_p)) return none;
    const R behind_m =
        p.gap_m - d.cacc.radar_delay_s * p.closing_mps - standstill_gap_m + stopping_distance_m(d, speed_p);
    return choose(stopping_p, stop_acceleration(d, speed_mps, behind_m), none);
}

// Fig. 4: the constant request u that makes the own acceleration meet the predicted one of the predecessor, in the least
// squares sense at three times within [start, end], limited to what is allowed. With first-order lags
//     a_p(t + th) = u_p + (a_p - u_p) exp(-(th + delay) / tau_p),   a(t + th) = u + (a - u) exp(-th / tau),
// so each time gives one equation w u = a_p(t + th) - (1 - w) a with w = 1 - exp(-th / tau).
template <class R, class Number>
STOPLINE_INLINE R predictive_feedforward(const CaccSettingsOf<Number>& c, const R& acceleration_mps2, const R& rate_1ps,
                                         const PredecessorView<R>& p) {
    const double middle_s = 0.5 * (c.prediction_start_s + c.prediction_end_s);
    const double half_s = middle_s - c.prediction_start_s;
    // exp is needed once for the first time and once for the step between times, for each vehicle.
    R own = exp_minus<R>(c.prediction_start_s * rate_1ps);
    const R own_step = exp_minus<R>(half_s * rate_1ps);
    R other = exp_minus<R>((c.prediction_start_s + c.v2v_delay_s) * p.rate_1ps);
    const R other_step = exp_minus<R>(half_s * p.rate_1ps);
    R numerator = splat<R>(0.0);
    R denominator = splat<R>(0.0);
    for (int k = 0; k < 3; ++k) {
        const R weight = 1.0 - own;
        const R target = p.request_mps2 + (p.acceleration_mps2 - p.request_mps2) * other;
        numerator += weight * (target - own * acceleration_mps2);
        denominator += weight * weight;
        own *= own_step;
        other *= other_step;
    }
    return limited(numerator / denominator, -c.deceleration_emergency_mps2, c.acceleration_max_mps2);
}

// Following: answer of the spacing controller. `desired_gap_m` and `slope_s` come from the gap law at the own speed;
// `request_mps2` is the request of the last step, the state of the filter 1 / H. That filter delays braking, for which a time gap leaves room.
// Where less room than what stands here is wanted beyond the gap at standstill (`growth_m`), or is there, and the predecessor brakes harder than
// this (our choice: harder than for anything but a stop), braking is as with a constant distance.
inline constexpr double kRoomToFilter_s = 0.3;
inline constexpr double kHardBraking_mps2 = 2.0;

template <class R, class Number>
STOPLINE_INLINE R follow_acceleration(const CaccSettingsOf<Number>& c, const R& speed_mps, const R& acceleration_mps2,
                                      const R& lag_s, const R& rate_1ps, const R& request_mps2, const R& desired_gap_m,
                                      const R& growth_m, const R& slope_s, const PredecessorView<R>& p, double dt) {
    const R error_m = p.gap_m - desired_gap_m;
    const R error_rate_mps = -p.closing_mps - slope_s * acceleration_mps2;
    const R feedback = c.feedback_kp_1ps2 * error_m + c.feedback_kd_1ps * error_rate_mps;
    const R time_gap_ff = p.acceleration_mps2 + lag_s * p.rate_1ps * (p.request_mps2 - p.acceleration_mps2);
    const R filtered = request_mps2 + (feedback + time_gap_ff - request_mps2) * lag_share(dt, slope_s);
    const R constant = STOPLINE_FLAG(R, slope_s <= 0.0);
    const R room_m = growth_m + lesser(error_m, 0.0);
    const R narrow =
        STOPLINE_FLAG(R, room_m < kRoomToFilter_s * speed_mps) * STOPLINE_FLAG(R, p.request_mps2 < -kHardBraking_mps2);
    R answer = filtered;
    if (any(greater(constant, narrow))) {
        const R distance = c.feedback_kp_1ps2 * error_m - c.feedback_kd_1ps * p.closing_mps +
                           predictive_feedforward(c, acceleration_mps2, rate_1ps, p);
        answer = choose(constant, distance, choose(narrow, lesser(distance, filtered), filtered));
    }
    return limited(answer, -c.deceleration_comfort_mps2, c.acceleration_max_mps2);
}

// Emergency: the least even deceleration with which the predecessor, braking evenly with b_p, is not hit, once it exceeds the
// threshold; large (no limit) before. Where the speeds meet before the predecessor stands (after 2 room / closing < v_p / b_p) it is
// b_p + closing^2 / (2 room), else v^2 / (2 (room + v_p^2 / (2 b_p))), which stops behind its place of rest.
//
// Braking is 15 % stronger than needed (our choice), since the brake lags: with exactly what is needed now it would always
// come late, and the need would grow.
inline constexpr double kEmergencyMargin = 1.15;

template <class R, class Number>
STOPLINE_INLINE R emergency_acceleration(const CaccSettingsOf<Number>& c, const R& speed_mps,
                                         const PredecessorView<R>& p) {
    const R closing = greater(p.closing_mps, 0.0);
    const R room_m = greater(p.gap_m - c.radar_delay_s * p.closing_mps - c.emergency_gap_m, 0.05);
    const R asked_p = lesser(p.acceleration_mps2, p.request_mps2);
    const R braking_p = limited(0.0 - asked_p, 0.01, c.deceleration_emergency_mps2);
    const R speed_p = greater(speed_mps - p.closing_mps, 0.0);
    const R twice = 2.0 * room_m * braking_p;
    const R meet = STOPLINE_FLAG(R, twice < speed_p * closing);
    const R over = choose(meet, twice + square(closing), square(speed_mps) * braking_p);
    const R under = choose(meet, 2.0 * room_m, twice + square(speed_p));
    const R urgent = STOPLINE_FLAG(R, over > c.emergency_threshold_mps2 * under);
    const R none = splat<R>(1e3);
    if (!any(urgent)) return none;
    const R braking = lesser(kEmergencyMargin * (over / under), c.deceleration_emergency_mps2);
    return choose(urgent, 0.0 - braking, none);
}

// Foresight: should the predecessor brake with all it has at once, braking with as much must be enough. From above,
//     v_safe^2 = v_p^2 + 2 b room
// (the safe speed of Gipps 1981 where both hear of it at once). A vehicle that is faster lets the room fall no further than its
// speed follows, d v_safe / dt = (v_p a_p - b closing) / v_safe, and returns to the curve. No limit below that speed. A reserve of
// time covers what the own brake is late (our choice: its lag of 0.2 s and half as much for the command to change). Whoever keeps a
// distance at all speeds hears of braking in time by its feedforward; a time gap delays that as well (H = 1 + h s), so that a vehicle
// nearer than its policy wants would use up its room: such a policy keeps the reserve at its own speed too, up to half of what the gap
// that it wants exceeds that at standstill by (`growth_m`; 0 for a constant distance). With all of it SWITCH-2 would brake in each
// start, where gaps grow later than speeds. Just above the speed from which its gap grows that is next to nothing: there it keeps
// kLeastReserve_s (our choice; with 0.25 s the starts of Section III would be slower).
inline constexpr double kBrakeReserve_s = 0.3;
inline constexpr double kReservedGrowth = 0.5;
inline constexpr double kLeastReserve_s = 0.15;

template <class R, class Number>
STOPLINE_INLINE R keep_room_acceleration(const CaccSettingsOf<Number>& c, const R& speed_mps, const R& growth_m,
                                         const PredecessorView<R>& p) {
    constexpr double kSpeedGain_1ps = 2.0;  // our choice: slower than the brake answers
    const double b = c.deceleration_emergency_mps2;
    const R late_m = (c.radar_delay_s + kBrakeReserve_s) * greater(p.closing_mps, 0.0);
    const R reserve_m = greater(lesser(kBrakeReserve_s * speed_mps, kReservedGrowth * growth_m),
                                kLeastReserve_s * speed_mps * STOPLINE_FLAG(R, growth_m > 0.0));
    const R room_m = greater(p.gap_m - late_m - reserve_m - c.emergency_gap_m, 0.05);
    const R speed_p = greater(speed_mps - p.closing_mps, 0.0);
    const R safe_squared = square(speed_p) + 2.0 * b * room_m;
    const R faster = STOPLINE_FLAG(R, square(speed_mps) > safe_squared);
    const R none = splat<R>(1e3);
    if (!any(faster)) return none;
    const R safe_mps = square_root(safe_squared);
    const R along = (speed_p * lesser(p.acceleration_mps2, 0.0) - b * p.closing_mps) / safe_mps;
    const R answer = greater(along + kSpeedGain_1ps * (safe_mps - speed_mps), 0.0 - b);
    return choose(faster, answer, none);
}

// One on the own way that is not followed, since one that goes another way drives in between: it must not be hit when that one is gone.
// Large (no limit) while there is nothing to fear. `growth_m`: as for keep_room_acceleration.
inline double mind_acceleration(const DriverTables& d, double speed_mps, double standstill_gap_m, double growth_m,
                                const PredecessorView<double>& p) {
    const double not_hit_mps2 =
        lesser(emergency_acceleration(d.cacc, speed_mps, p), keep_room_acceleration(d.cacc, speed_mps, growth_m, p));
    return lesser(not_hit_mps2, stop_behind_acceleration(d, speed_mps, standstill_gap_m, p));
}

}  // namespace stopline
