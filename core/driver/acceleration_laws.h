// The laws of the longitudinal controller in full dynamics. Each law (driving freely, following, stopping, emergency
// braking, keeping room to brake) returns a desired acceleration, and the smallest one applies. Each law is a pure
// function without branches per vehicle. It computes one vehicle (double) or several at a time (Batch,
// base/simd/simd.h). The loops over vehicles are in sim/full_dynamics/full_kernels.inl.
//
// The law for following is the cascade of Fig. 3 of the paper: PD feedback on the gap measured by radar, and
// feedforward of the leader's state from V2V. Symbols: e = gap - d(v) is the error of the gap against the desired gap
// d, h is the time gap (slope of d), u is the requested acceleration, a is the realised acceleration, and tau is the
// lag of the powertrain. Values of the leader have the suffix _p. The spacing policy is H = 1 + h s, with s the
// variable of the Laplace transform. In the time domain, the request u for a constant time gap (CTG) or distance gap
// (CDG) is given by
//     CTG  (h > 0):  h du/dt = -u + kp e + kd de/dt + a_p + (tau / tau_p) (u_p - a_p)
//     CDG  (h = 0):        u =      kp e + kd de/dt + predictive_feedforward(...)
// (Ploeg et al. 2011, reference [31] of the paper.) The last term of CTG is tau times the jerk of the leader, because
// this jerk is (u_p - a_p) / tau_p. The term compensates the lag tau of the own powertrain.
#pragma once

#include <array>
#include <functional>
#include <type_traits>

#include "base/simd/arithmetic.h"
#include "driver/driver_settings.h"

namespace stopline {

// A law returns this value if it does not limit the acceleration. The value is higher than any acceleration, so it is
// never the smallest one.
inline constexpr double kUnconstrained_mps2 = 1e3;

// The parameters of human drivers (human.h): the maximum acceleration a of the intelligent driver model, and
// 1 / (2 sqrt(a b)) with its comfortable deceleration b.
template <class Number>
struct HumanTablesOf {
    Number acceleration_mps2 = 0.0;
    Number closing_s2pm = 0.0;
};

// The settings of the driver, prepared for the kernels (the loops over vehicles).
template <class Number>
struct DriverTablesOf {
    static constexpr int kProfileNodes = 32;
    CaccSettingsOf<Number> cacc;
    StopSettingsOf<Number> stop;
    HumanTablesOf<Number> human;
    Number speed_gain_1ps = 0.0;
    Number deceleration_mps2 = 0.0;  // braking before a lower speed limit
    Number profile_nodes_per_mps = 0.0;
    std::array<Number, kProfileNodes> profile_mps2{};  // [node] acceleration of free driving, from speed 0
    Number profile_end_mps = 1e9;                      // highest desired speed for which the profile holds
    // The next two members apply to desired speeds above profile_end_mps. extend_by_power() sets them.
    Number power_nodes_per_mps = 0.0;
    std::array<Number, kProfileNodes> power_mps2{};  // [node] lower bound of the acceleration; node 0 is speed 0
};
using DriverTables = DriverTablesOf<double>;

// Compiles the settings. Throws InputError if the acceleration profile is empty or incomplete.
DriverTables compile_driver(const DriverSettings& settings);
// Sets the accelerations for desired speeds above the range of the profile. `available_mps2` returns the highest
// acceleration of the vehicle, m/s2, at a given speed, m/s.
void extend_by_power(const FreeDriveSettings& free, const std::function<double(double)>& available_mps2,
                     DriverTables& tables);

// The measured and received data of a vehicle about its leader.
template <class R>
struct LeaderView {
    R gap_m;              // net gap, from the delayed radar
    R closing_mps;        // own speed minus the leader's, from the delayed radar
    R acceleration_mps2;  // realised acceleration a_p, from V2V, delayed
    R request_mps2;       // requested acceleration u_p, from V2V, delayed
    R rate_1ps;           // 1 / tau_p (inverse lag of the leader), from V2V, delayed
};

// Returns the acceleration of a vehicle without leader. This acceleration follows the calibrated start-up profile,
// and falls to 0 towards the desired speed. If the desired speed is beyond the range of the profile, the power of the
// vehicle gives a lower bound.
template <class R, class Number>
STOPLINE_INLINE R free_acceleration(const DriverTablesOf<Number>& d, const R& speed_mps,
                                    const std::type_identity_t<R>& desired_mps) {
    R profile = interpolate_on_grid(d.profile_mps2, R(speed_mps * d.profile_nodes_per_mps));
    const R is_beyond = STOPLINE_FLAG(R, desired_mps > splat<R>(static_cast<double>(d.profile_end_mps)));
    if (any(is_beyond)) {
        const R power = interpolate_on_grid(d.power_mps2, R(speed_mps * d.power_nodes_per_mps));
        profile = choose(is_beyond, max_of(profile, power), profile);
    }
    return min_of(profile, d.speed_gain_1ps * (desired_mps - speed_mps));
}

// Returns the desired speed of a platoon leader. If its radar sees no vehicle ahead, the result is the speed limit.
// Otherwise the result is slightly above the limit, so that the platoon leader can close up to a vehicle that drives at
// the limit. The platoon leader reaches the desired gap behind such a vehicle after the time
//     t = (gap - desired gap) / ((catch_up_factor - 1) limit).
// In the mesoscale mode, vehicles close up with about the same difference of speeds: a vehicle without leader drives at
// 95 % of the limit (Section V.A of the paper), and the vehicles behind it may drive at the limit.
template <class R, class Number>
STOPLINE_INLINE R closing_up_speed(const CaccSettingsOf<Number>& c, const R& limit_mps, const LeaderView<R>& p) {
    const R sees_leader = STOPLINE_FLAG(R, p.gap_m < splat<R>(static_cast<double>(c.radar_range_m)));
    return choose(sees_leader, limit_mps * c.catch_up_factor, limit_mps);
}

// Returns the upper limit of a follower's acceleration. To close its gap, a follower may exceed the start-up profile
// and, slightly, the desired speed.
template <class R, class Number>
STOPLINE_INLINE R catch_up_acceleration(const DriverTablesOf<Number>& d, const R& speed_mps,
                                        const std::type_identity_t<R>& desired_mps) {
    const R towards_limit = d.speed_gain_1ps * (desired_mps * d.cacc.catch_up_factor - speed_mps);
    return min_of(towards_limit, d.cacc.acceleration_max_mps2);
}

// Returns the acceleration before a lower speed limit `end_mps` that begins `distance_m` ahead. The vehicle follows the
// speed curve v^2 = end_mps^2 + 2 b distance, with the deceleration b.
template <class R, class Number>
STOPLINE_INLINE R slow_down_acceleration(const DriverTablesOf<Number>& d, const R& speed_mps, const R& end_mps,
                                         const R& distance_m) {
    const double b = d.deceleration_mps2;
    const R allowed_mps = square_root(square(end_mps) + 2.0 * b * max_of(distance_m, 0.0));
    return (allowed_mps - speed_mps) - b * speed_mps / max_of(allowed_mps, 1.0);
}

// Returns the acceleration for a stop after `distance_m`. The vehicle follows the speed curve
//     v_s = -b tau + sqrt((b tau)^2 + 2 b distance), where tau is kBrakingReaction_s.
// A vehicle that keeps the speed v_s for the time tau and then brakes with b stops exactly at that distance, without
// overshoot. v_s is the safe speed of Krauss 1998 behind a stopped obstacle. On the curve, the vehicle decelerates with
// b v / (v_s + b tau). If the vehicle has already passed the stopping point, b is added to the braking.
//
// Our choices: tau covers the lag of the brake (0.2 s) and the time that the request needs to change. The gain
// kSpeedGain_1ps returns the vehicle to the curve with the time constant 1 / gain = 0.7 s. The brake responds faster
// than 0.7 s, so the speed does not oscillate.
template <class R, class Number>
STOPLINE_INLINE R stop_acceleration(const DriverTablesOf<Number>& d, const R& speed_mps, const R& distance_m) {
    constexpr double kSpeedGain_1ps = 1.5;
    const double b = d.stop.deceleration_mps2;
    const double bt = b * kBrakingReaction_s;
    const R curve_mps = square_root(square(bt) + 2.0 * b * max_of(distance_m, 0.0)) - bt;
    const R late = select(distance_m > 0.0, splat<R>(0.0), splat<R>(-b));
    return late + kSpeedGain_1ps * (curve_mps - speed_mps) - b * speed_mps / (curve_mps + bt);
}

// Returns the acceleration for a stop at a line, also if the vehicle learns of the stop too late to follow the curve of
// stop_acceleration(). It then brakes at least with v^2 / (2 distance), the constant deceleration that stops it at the
// line. The braking is limited to the constant deceleration that stops the vehicle if it drives on for
// kBrakingReaction_s first, or to `stop.deceleration` if that is higher. This limit keeps late braking nearly constant.
// The curve alone would demand hard braking first and gentle braking later.
inline double stop_at_line_acceleration(const DriverTables& d, double speed_mps, double distance_m) {
    const auto constant_mps2 = [=](double room_m) { return 0.5 * square(speed_mps) / max_of(room_m, 0.1); };
    const double needed_mps2 = constant_mps2(distance_m);
    const double later_mps2 = constant_mps2(distance_m - speed_mps * kBrakingReaction_s);
    const double b = d.stop.deceleration_mps2;
    const double limited_mps2 = max_of(stop_acceleration(d, speed_mps, distance_m), -max_of(b, later_mps2));
    return needed_mps2 > b ? min_of(limited_mps2, -needed_mps2) : limited_mps2;
}

// Returns the stopping distance along the curve of stop_acceleration(): v^2 / (2 b) + v tau.
template <class R, class Number>
STOPLINE_INLINE R stopping_distance_m(const DriverTablesOf<Number>& d, const R& speed_mps) {
    return speed_mps * (speed_mps * (0.5 / d.stop.deceleration_mps2) + kBrakingReaction_s);
}

inline constexpr double kStoppingLeader_mps = 5.0;
inline constexpr double kStoppingLeaderBraking_mps2 = 0.2;

// Returns the acceleration for a stop behind a leader that is about to stop, or kUnconstrained_mps2 for any other
// leader. A leader is about to stop if it is slower than kStoppingLeader_mps and requests a deceleration of at least
// kStoppingLeaderBraking_mps2. For a leader slower than 1 m/s, the required deceleration is smaller, in proportion to
// the speed of the leader. A stopped leader thus counts as about to stop until it requests a positive acceleration.
template <class R, class Number>
STOPLINE_INLINE R stop_behind_acceleration(const DriverTablesOf<Number>& d, const R& speed_mps,
                                           const R& standstill_gap_m, const LeaderView<R>& p) {
    const R speed_p = max_of(speed_mps - p.closing_mps, 0.0);
    const R stopping_p =
        STOPLINE_FLAG(R, p.request_mps2 <= splat<R>(0.0) - min_of(speed_p, 1.0) * kStoppingLeaderBraking_mps2) *
        STOPLINE_FLAG(R, speed_p < kStoppingLeader_mps);
    const R unconstrained = splat<R>(kUnconstrained_mps2);
    if (!any(stopping_p)) return unconstrained;
    const R behind_m =
        p.gap_m - d.cacc.radar_delay_s * p.closing_mps - standstill_gap_m + stopping_distance_m(d, speed_p);
    return choose(stopping_p, stop_acceleration(d, speed_mps, behind_m), unconstrained);
}

// Returns the predictive feedforward of Fig. 4: the constant request u that brings the own acceleration to that of the
// leader. u minimises the sum of the squared differences between both accelerations at three times in the prediction
// horizon, and is limited to the allowed range. With first-order lags and the V2V delay, the accelerations after a
// further time th are
//     a_p(t + th) = u_p + (a_p - u_p) exp(-(th + delay) / tau_p),   a(t + th) = u + (a - u) exp(-th / tau).
// Each of the three times thus gives one equation for u: w u = a_p(t + th) - (1 - w) a with w = 1 - exp(-th / tau).
template <class R, class Number>
STOPLINE_INLINE R predictive_feedforward(const CaccSettingsOf<Number>& c, const R& acceleration_mps2, const R& rate_1ps,
                                         const LeaderView<R>& p) {
    const double middle_s = 0.5 * (c.prediction_start_s + c.prediction_end_s);
    const double half_s = middle_s - c.prediction_start_s;
    // To save time, exp is computed only for the first of the three times and for the step between two times.
    R own = exp_negative<R>(c.prediction_start_s * rate_1ps);
    const R own_step = exp_negative<R>(half_s * rate_1ps);
    R other = exp_negative<R>((c.prediction_start_s + c.v2v_delay_s) * p.rate_1ps);
    const R other_step = exp_negative<R>(half_s * p.rate_1ps);
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
    return clamped(numerator / denominator, -c.deceleration_emergency_mps2, c.acceleration_max_mps2);
}

inline constexpr double kMinFilterRoom_s = 0.3;
inline constexpr double kHardBraking_mps2 = 2.0;

// Returns the acceleration of the spacing controller. `desired_gap_m` and `slope_s` come from the spacing law at the
// current speed. `request_mps2` is the request of the previous step, which is the state of the filter 1 / H.
//
// The filter delays braking. With a time gap, the vehicle normally has room for this delay. The room is `gap_growth_m`
// (the desired gap minus the standstill gap). If the gap is shorter than desired, the difference is subtracted from the
// room. The delay is too long if the vehicle covers the room in less than kMinFilterRoom_s and the leader requests a
// deceleration above kHardBraking_mps2. The vehicle then brakes at least as hard as with a constant distance gap. Both
// thresholds are our choice. A leader brakes harder than kHardBraking_mps2 only to stop.
template <class R, class Number>
STOPLINE_INLINE R follow_acceleration(const CaccSettingsOf<Number>& c, const R& speed_mps, const R& acceleration_mps2,
                                      const R& lag_s, const R& rate_1ps, const R& request_mps2, const R& desired_gap_m,
                                      const R& gap_growth_m, const R& slope_s, const LeaderView<R>& p, double dt) {
    const R error_m = p.gap_m - desired_gap_m;
    const R error_rate_mps = -p.closing_mps - slope_s * acceleration_mps2;
    const R feedback = c.feedback_kp_1ps2 * error_m + c.feedback_kd_1ps * error_rate_mps;
    const R feedforward = p.acceleration_mps2 + lag_s * p.rate_1ps * (p.request_mps2 - p.acceleration_mps2);
    const R filtered = request_mps2 + (feedback + feedforward - request_mps2) * lag_share(dt, slope_s);
    const R is_constant_distance = STOPLINE_FLAG(R, slope_s <= 0.0);
    const R room_m = gap_growth_m + min_of(error_m, 0.0);
    const R has_little_room =
        STOPLINE_FLAG(R, room_m < kMinFilterRoom_s * speed_mps) * STOPLINE_FLAG(R, p.request_mps2 < -kHardBraking_mps2);
    R result = filtered;
    if (any(max_of(is_constant_distance, has_little_room))) {
        const R distance_control = c.feedback_kp_1ps2 * error_m - c.feedback_kd_1ps * p.closing_mps +
                                   predictive_feedforward(c, acceleration_mps2, rate_1ps, p);
        result = choose(is_constant_distance, distance_control,
                        choose(has_little_room, min_of(distance_control, filtered), filtered));
    }
    return clamped(result, -c.deceleration_comfort_mps2, c.acceleration_max_mps2);
}

inline constexpr double kEmergencyMargin = 1.15;

// Returns the emergency braking, or kUnconstrained_mps2 while the needed deceleration is below the threshold of the
// settings. The needed deceleration is the smallest constant one that avoids a collision if the leader brakes
// constantly with b_p. The own speed is v, and the speed of the leader is v_p.
//
// Here `room` is the net gap minus the gap that must remain, and `closing` is the closing speed. If the vehicle reaches
// the speed of the leader before the leader stops (if 2 room / closing < v_p / b_p), the needed deceleration is b_p +
// closing^2 / (2 room). Otherwise the needed deceleration is v^2 / (2 (room + v_p^2 / (2 b_p))), and the vehicle stops
// behind the stopped leader.
//
// The factor kEmergencyMargin makes the request stronger than needed (our choice), because the brake lags. Without this
// factor, the braking would always come late, and the needed deceleration would grow.
template <class R, class Number>
STOPLINE_INLINE R emergency_acceleration(const CaccSettingsOf<Number>& c, const R& speed_mps, const LeaderView<R>& p) {
    const R closing = max_of(p.closing_mps, 0.0);
    const R room_m = max_of(p.gap_m - c.radar_delay_s * p.closing_mps - c.emergency_gap_m, 0.05);
    const R demand_p = min_of(p.acceleration_mps2, p.request_mps2);
    const R braking_p = clamped(0.0 - demand_p, 0.01, c.deceleration_emergency_mps2);
    const R speed_p = max_of(speed_mps - p.closing_mps, 0.0);
    const R room_braking = 2.0 * room_m * braking_p;
    const R speeds_meet = STOPLINE_FLAG(R, room_braking < speed_p * closing);
    const R numerator = choose(speeds_meet, room_braking + square(closing), square(speed_mps) * braking_p);
    const R denominator = choose(speeds_meet, 2.0 * room_m, room_braking + square(speed_p));
    const R urgent = STOPLINE_FLAG(R, numerator > c.emergency_threshold_mps2 * denominator);
    const R unconstrained = splat<R>(kUnconstrained_mps2);
    if (!any(urgent)) return unconstrained;
    const R braking = min_of(kEmergencyMargin * (numerator / denominator), c.deceleration_emergency_mps2);
    return choose(urgent, 0.0 - braking, unconstrained);
}

// Delay of braking, our choice: sum of the lag of the brake (0.2 s) and of the time that the requested acceleration
// needs to change (about 0.1 s).
inline constexpr double kBrakeResponse_s = 0.3;

// Constants of keep_room_acceleration(), whose comment explains their use. Both values are our choice.
//
// If this share were 1, vehicles with the policy SWITCH-2 would brake during every start.
inline constexpr double kReservedGrowthShare = 0.5;
// A larger value would slow down the starts of Section III of the paper.
inline constexpr double kMinReserve_s = 0.15;

// Returns the braking that keeps room for the case that the leader brakes with the maximum deceleration b at once. Up
// to the safe speed v_safe, the law returns kUnconstrained_mps2. A vehicle at v_safe just avoids a collision if it also
// brakes with b:
//     v_safe^2 = v_p^2 + 2 b room
// This is the safe speed of Gipps 1981 for two vehicles that begin to brake at the same time. A vehicle faster than
// v_safe decelerates at the rate at which v_safe falls, d v_safe / dt = (v_p a_p - b closing) / v_safe. The vehicle
// brakes a little harder than that, to return to v_safe.
//
// The room is the net gap, minus the gap that must remain, minus two reserves. The first reserve covers the delays of
// radar and brake. It is the closing speed times the sum of the radar delay and kBrakeResponse_s. The second reserve is
// for policies with a time gap. Their filter (H = 1 + h s) also delays braking, so a vehicle with a short gap would use
// up its room. The second reserve is the own speed times kBrakeResponse_s, but at most kReservedGrowthShare of
// `gap_growth_m`, the desired gap minus the standstill gap. Just above a switch speed gap_growth_m is almost 0, so this
// reserve is at least the own speed times kMinReserve_s. With a constant distance gap_growth_m is 0 and there is no
// second reserve, because the feedforward reports the leader's braking in time.
template <class R, class Number>
STOPLINE_INLINE R keep_room_acceleration(const CaccSettingsOf<Number>& c, const R& speed_mps, const R& gap_growth_m,
                                         const LeaderView<R>& p) {
    constexpr double kSpeedGain_1ps = 2.0;  // our choice: a slower response than that of the brake
    const double b = c.deceleration_emergency_mps2;
    const R delay_m = (c.radar_delay_s + kBrakeResponse_s) * max_of(p.closing_mps, 0.0);
    const R reserve_m = max_of(min_of(kBrakeResponse_s * speed_mps, kReservedGrowthShare * gap_growth_m),
                               kMinReserve_s * speed_mps * STOPLINE_FLAG(R, gap_growth_m > 0.0));
    const R room_m = max_of(p.gap_m - delay_m - reserve_m - c.emergency_gap_m, 0.05);
    const R speed_p = max_of(speed_mps - p.closing_mps, 0.0);
    const R safe_squared = square(speed_p) + 2.0 * b * room_m;
    const R is_faster = STOPLINE_FLAG(R, square(speed_mps) > safe_squared);
    const R unconstrained = splat<R>(kUnconstrained_mps2);
    if (!any(is_faster)) return unconstrained;
    const R safe_mps = square_root(safe_squared);
    const R along_curve = (speed_p * min_of(p.acceleration_mps2, 0.0) - b * p.closing_mps) / safe_mps;
    const R result = max_of(along_curve + kSpeedGain_1ps * (safe_mps - speed_mps), 0.0 - b);
    return choose(is_faster, result, unconstrained);
}

// Returns the braking of a driver without V2V that keeps room for the case that the leader brakes with the maximum
// deceleration b at once. Up to the safe speed, the law returns kUnconstrained_mps2. The driver learns of the braking
// only from its radar. It responds after the radar delay and kBrakeResponse_s. If both vehicles then brake with b,
// their gap has shrunk by the own speed times this time t:
//     v_safe^2 = v_p^2 + 2 b (gap - v t - gap that must remain)
// If the gap is too short, v_safe is below the speed of the leader. The driver then falls back, even if its policy asks
// for a shorter gap.
inline double keep_response_room_acceleration(const CaccSettings& c, double speed_mps, const LeaderView<double>& p) {
    constexpr double kSpeedGain_1ps = 2.0;   // as in keep_room_acceleration()
    constexpr double kLeastSpeed_mps = 1.0;  // our choice: limits the slope of the curve near standstill
    const double b = c.deceleration_emergency_mps2;
    const double response_s = c.radar_delay_s + kBrakeResponse_s;
    const double room_m = p.gap_m - response_s * (speed_mps + max_of(p.closing_mps, 0.0)) - c.emergency_gap_m;
    const double speed_p = max_of(speed_mps - p.closing_mps, 0.0);
    const double safe_mps = square_root(max_of(square(speed_p) + 2.0 * b * room_m, 0.0));
    if (speed_mps <= safe_mps) return kUnconstrained_mps2;
    const double along_curve =
        (speed_p * min_of(p.acceleration_mps2, 0.0) - b * p.closing_mps) / max_of(safe_mps, kLeastSpeed_mps);
    return max_of(along_curve + kSpeedGain_1ps * (safe_mps - speed_mps), -b);
}

// Returns the braking for a hidden leader, or kUnconstrained_mps2 if no braking is needed. The own leader will leave
// the route of the own vehicle. Until then it hides the vehicle ahead of it, the hidden leader, which stays on the
// route. The own vehicle must not hit the hidden leader later. `p` is the view of the hidden leader, and `gap_growth_m`
// is the desired gap minus the standstill gap.
inline double hidden_leader_acceleration(const DriverTables& d, double speed_mps, double standstill_gap_m,
                                         double gap_growth_m, const LeaderView<double>& p) {
    const double collision_free_mps2 = min_of(emergency_acceleration(d.cacc, speed_mps, p),
                                              keep_room_acceleration(d.cacc, speed_mps, gap_growth_m, p));
    return min_of(collision_free_mps2, stop_behind_acceleration(d, speed_mps, standstill_gap_m, p));
}

}  // namespace stopline
