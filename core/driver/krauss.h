// The car-following models of Krauss's family. They compute the speed of the next step from the state at the start of
// the step.
//
// Policies with a time gap use the model of Krauss (1998, "Microscopic modeling of traffic flow", chapter
// 5), with its condition for safe driving solved for the speed, as in SUMO. At a net gap s behind a leader with the
// speed v_l, the safe speed is (struct Krauss explains the other symbols):
//
//   v_safe = -b tau + sqrt(b^2 tau^2 + v_l^2 + 2 b (s - s_0))
//
// Policies with a constant distance use equation (1) of the paper. In the printed equation, v_safe jumps at s_0,
// because a plus sign is missing. The model restores the plus sign:
//
//   s > s_0               v_safe as above, with s_0 + s_t in place of s_0
//   s_0 - s_t < s <= s_0  v_safe = v_l
//   s <= s_0 - s_t        v_safe = d v_l
//
// In equilibrium at speed v the gap is s_0 + tau v in the first model and s_0 + s_t + tau v in equation (1). With the
// maximum acceleration a, speed and position after a step dt are
//
//   v' = min(v_safe, v + a(v) dt, cap),  v <- max(0, v' - sigma dt xi min(v', a 1 s)),  x <- x + v dt
//
// Here xi is uniform in [0, 1), and `cap` is the highest speed that the speed limit and the stop line allow. Slow
// vehicles dawdle less, so that dawdling never prevents a start (as in SUMO). A v' below 1 cm/s is set to 0. If the
// policy has an extra gap (MesoGap), s_0 also contains the extra gap at the current speed.
//
// The following extensions are off in the models of the paper:
//   constant power   a(v) = a min(1, v_p / v); in the paper v_p is above all speed limits
//   anticipation     behind a leader that accelerates with a_l, v_l + T a_l replaces v_l
//   transient gap    s_0 grows in proportion to a_l
//   gap tracking     the vehicle keeps its time gap even behind a faster leader, see track_time_gap()
//   catching up      the maximum acceleration a is larger close behind the leader
#pragma once

#include <algorithm>
#include <array>
#include <utility>

#include "driver/following_model.h"

namespace stopline {

// The parameters of several vehicles, which may have different policies. The members mean the same as in Krauss.
template <class R>
struct KraussPerVehicle {
    R acceleration_mps2, constant_power_speed_mps, transient_gap_s2, catch_up_factor, gap_tracking, anticipation_s;
    R deceleration_mps2, reaction_s, standstill_gap_m, dawdling;
    decltype(std::declval<R>() < std::declval<R>()) constant_distance;
    R band_m, below_band_speed_share;
};

// The model of one spacing policy, ready for use. SI units. The concept CarFollowing (following_model.h) explains the
// functions.
struct Krauss {
    static constexpr std::array kNames{
        FollowingName{kConstantDistanceFamily, "equation (1) of the paper: a constant distance"},
        FollowingName{kTimeGapFamily, "the model of Krauss: a time gap"}};

    double acceleration_mps2 = 0.0;         // a, maximum acceleration
    double constant_power_speed_mps = 1e9;  // v_p, speed from which on the power is constant
    // Extra gap per m/s2 of the leader's acceleration; not used if the leader brakes.
    double transient_gap_s2 = 0.0;
    double catch_up_factor = 1.0;         // factor on the acceleration close behind the leader
    double gap_tracking = 0.0;            // 0 .. 1, see track_time_gap()
    double anticipation_s = 0.0;          // T, time over which the leader's speed is extrapolated
    double deceleration_mps2 = 0.0;       // b, expected deceleration of both vehicles
    double reaction_s = 0.0;              // tau, reaction time
    double standstill_gap_m = 0.0;        // s_0
    double dawdling = 0.0;                // sigma, 0 .. 1
    bool constant_distance = false;       // true: equation (1); false: Krauss
    double band_m = 0.0;                  // s_t of equation (1); 0 for Krauss
    double below_band_speed_share = 1.0;  // d of equation (1)

    // Makes the model of a spacing policy. If the time gap or the standstill gap of the policy differs from the
    // calibrated one, tau or s_0 changes by the difference.
    static Krauss make(const FollowingSettings& settings, const MesoGap& gap);

    double equilibrium_gap_m(double speed_mps) const { return standstill_gap_m + band_m + reaction_s * speed_mps; }
    double smallest_gap_m() const { return standstill_gap_m - band_m; }
    FollowingBraking braking() const { return {deceleration_mps2, reaction_s}; }
    bool relays_starts() const { return constant_distance; }
    // If no model has a power limit, the kernels save a division per vehicle.
    bool has_power_limit() const { return constant_power_speed_mps < 100.0; }
    bool leader_uses_following_speed() const { return transient_gap_s2 == 0.0; }
    SumoFollowing in_sumo() const {
        return {"Krauss", acceleration_mps2, deceleration_mps2, reaction_s, standstill_gap_m + band_m,
                dawdling, !constant_distance};
    }

    template <class R, class Model, class Random>
    static R following_speed_mps(const Model& k, const FollowingInputOf<R>& in, const Random& random, double dt);
    template <class R, class Model>
    static R leader_speed_mps(const Model& k, const FollowingInputOf<R>& in, const R& following_mps, bool relays,
                              bool uses_following_speed);
    template <bool power_limit, class R, class Model>
    static R desired_speed_mps(const Model& k, const FollowingInputOf<R>& in, const R& following_mps, double dt,
                               const R& least_mps2);
    template <class R, class Model, class Random>
    static R disturbed_speed_mps(const Model& k, const R& bounded_mps, const Random& random, double dt);

    // Returns the parameters of each vehicle in a run with two policies: `a` for policy 0, `b` for policy 1.
    template <class R>
    static KraussPerVehicle<R> of_two_policies(const R& policy, const Krauss& a, const Krauss& b);
};

// The functions below compute one vehicle or several at a time (base/simd/simd.h). `Model` is Krauss or
// KraussPerVehicle.

// Returns v_safe for a net gap. `extra_gap_m` is added to s_0: the extra gap of the policy (MesoGap) at the
// current speed.
template <class R, class Model>
STOPLINE_INLINE R safe_speed_mps(const Model& k, const R& gap_m, const R& leader_speed_mps, const R& extra_gap_m) {
    const R spare_gap_m = gap_m - k.standstill_gap_m - extra_gap_m;
    const R braking = braking_speed_mps(k.deceleration_mps2, k.reaction_s, R(spare_gap_m - k.band_m), leader_speed_mps);
    const R close = select(spare_gap_m > -k.band_m, leader_speed_mps, R(k.below_band_speed_share * leader_speed_mps));
    return select(k.constant_distance, select(spare_gap_m <= 0.0, close, braking), braking);
}

// Returns v_safe, reduced so that the vehicle keeps its time gap. v_safe allows a shorter gap while the leader is
// faster, because a faster leader needs longer to stop. Full tracking (gap_tracking = 1) limits the speed to
// (s - s_0) / tau. With partial tracking the speed lies between that limit and v_safe.
template <class R, class Model>
STOPLINE_INLINE R track_time_gap(const Model& k, const FollowingInputOf<R>& in, const R& extra_gap_m,
                                 const R& safe_mps) {
    const R time_gap_mps = (in.gap_m - k.standstill_gap_m - extra_gap_m) * (1.0 / max_of(R(k.reaction_s), R(0.05)));
    const R reduction_mps = k.gap_tracking * max_of(safe_mps - time_gap_mps, R(0.0));
    return select(k.constant_distance, safe_mps, R(safe_mps - reduction_mps));
}

// Returns v_safe for the anticipated speed of the leader.
template <class R, class Model>
STOPLINE_INLINE R anticipated_safe_speed_mps(const Model& k, const FollowingInputOf<R>& in, const R& extra_gap_m) {
    return safe_speed_mps(k, in.gap_m, R(in.leader_speed_mps + k.anticipation_s * in.leader_acceleration_mps2),
                          extra_gap_m);
}

// Returns v_safe for the anticipated speed of the leader, with the transient gap added to the extra gap.
template <class R, class Model, class Random>
STOPLINE_INLINE R Krauss::following_speed_mps(const Model& k, const FollowingInputOf<R>& in, const Random& /*random*/,
                                              double /*dt*/) {
    return anticipated_safe_speed_mps(k, in, R(in.extra_gap_m + k.transient_gap_s2 * in.leader_acceleration_mps2));
}

template <class R, class Model>
STOPLINE_INLINE R Krauss::leader_speed_mps(const Model& k, const FollowingInputOf<R>& in, const R& following_mps,
                                           bool relays, bool uses_following_speed) {
    if (uses_following_speed) return following_mps;
    return relays ? anticipated_safe_speed_mps(k, in, in.extra_gap_m)
                  : safe_speed_mps(k, in.gap_m, in.leader_speed_mps, in.extra_gap_m);
}

template <bool power_limit, class R, class Model>
STOPLINE_INLINE R Krauss::desired_speed_mps(const Model& k, const FollowingInputOf<R>& in, const R& following_mps,
                                            double dt, const R& least_mps2) {
    const R extra_gap_m = in.extra_gap_m + k.transient_gap_s2 * in.leader_acceleration_mps2;
    const R safe = track_time_gap(k, in, extra_gap_m, following_mps);
    R acceleration = k.acceleration_mps2;
    if constexpr (power_limit)
        acceleration = max_of(
            acceleration * min_of(R(1.0), R(k.constant_power_speed_mps / max_of(in.speed_mps, R(1e-3)))), least_mps2);
    constexpr double kCatchUp_m = 2.0;  // catch_up_factor applies up to this excess over the equilibrium gap
    const R equilibrium_m = k.standstill_gap_m + k.band_m + k.reaction_s * in.speed_mps;
    const R factor = select(in.gap_m - in.extra_gap_m < equilibrium_m + kCatchUp_m, R(k.catch_up_factor), R(1.0));
    const R accelerated = in.speed_mps + acceleration * factor * dt;
    return min_of(safe, accelerated);
}

template <class R, class Model, class Random>
STOPLINE_INLINE R Krauss::disturbed_speed_mps(const Model& k, const R& bounded_mps, const Random& random, double dt) {
    constexpr double kSlow_s = 1.0;  // vehicles slower than a x 1 s dawdle in proportion to their speed
    return bounded_mps - k.dawdling * dt * random.dawdle() * min_of(bounded_mps, R(k.acceleration_mps2 * kSlow_s));
}

template <class R>
STOPLINE_INLINE KraussPerVehicle<R> Krauss::of_two_policies(const R& policy, const Krauss& a, const Krauss& b) {
    const auto second = policy > 0.0;
    const auto pick = [&](double first, double other)
                          STOPLINE_INLINE_LAMBDA { return select(second, R(other), R(first)); };
    return {pick(a.acceleration_mps2, b.acceleration_mps2),
            pick(a.constant_power_speed_mps, b.constant_power_speed_mps),
            pick(a.transient_gap_s2, b.transient_gap_s2),
            pick(a.catch_up_factor, b.catch_up_factor),
            pick(a.gap_tracking, b.gap_tracking),
            pick(a.anticipation_s, b.anticipation_s),
            pick(a.deceleration_mps2, b.deceleration_mps2),
            pick(a.reaction_s, b.reaction_s),
            pick(a.standstill_gap_m, b.standstill_gap_m),
            pick(a.dawdling, b.dawdling),
            pick(a.constant_distance ? 1.0 : 0.0, b.constant_distance ? 1.0 : 0.0) > 0.5,
            pick(a.band_m, b.band_m),
            pick(a.below_band_speed_share, b.below_band_speed_share)};
}

template <>
struct FollowingAt<0> {
    using Trait = Krauss;
};

}  // namespace stopline
