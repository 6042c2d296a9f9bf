// The intelligent driver model (IDM) of Treiber, Hennecke, Helbing 2000, "Congested traffic states in empirical
// observations and microscopic simulations", Physical Review E 62. The acceleration depends on the speed v, the net gap
// s, the leader's speed v_l and the desired speed v_0:
//
//   a (1 - (v / v_0)^4 - (s* / s)^2)    with    s* = s_0 + max(0, T v + v (v - v_l) / (2 sqrt(a b)))
//
// Here a is the maximum acceleration, b the comfortable deceleration, T the time gap and s_0 the standstill gap. In
// equilibrium at speed v the gap is (s_0 + T v) / sqrt(1 - (v / v_0)^4). The exponent 4 comes from the source. The
// maximum with 0 comes from Treiber, Kesting 2013, "Traffic Flow Dynamics", section 11.3.
//
// In the mesoscale mode, v_0 is the speed limit of the lane times the speed factor. The spacing policy gives s_0 and T.
// If the policy has an extra gap (MesoGap), s_0 also contains the extra gap at the current speed. Speed and position
// after a step dt are
//
//   v' = v + dt x acceleration,  x <- x + v' dt
//
// The IDM alone prevents collisions only if the steps are short. bounded_speed_mps() prevents them for all steps.
#pragma once

#include <array>
#include <cmath>

#include "driver/following_model.h"

namespace stopline {

// The parameters a, b, T and s_0 of the IDM.
struct IdmParameters {
    double acceleration_mps2 = 0.0;
    double deceleration_mps2 = 0.0;
    double time_gap_s = 0.0;
    double standstill_gap_m = 0.0;
    double closing_s2pm = 0.0;  // 1 / (2 sqrt(a b)); idm_parameters() sets it

    // Returns s* at equal speeds. Well below the desired speed, this is the equilibrium gap.
    double equilibrium_gap_m(double speed_mps) const { return standstill_gap_m + time_gap_s * speed_mps; }
};

inline IdmParameters idm_parameters(const IdmSettings& settings, double standstill_gap_m, double time_gap_s) {
    const double ab = settings.acceleration_mps2 * settings.deceleration_mps2;
    return {settings.acceleration_mps2, settings.deceleration_mps2, time_gap_s, standstill_gap_m, 0.5 / std::sqrt(ab)};
}

inline constexpr double kMinIdmGap_m = 0.1;  // shorter gaps count as this gap

// Returns (s* / s)^2 for the speed, the closing speed v - v_l and the net gap. `standstill_gap_m` is s_0, and
// `growth_m` is T v.
template <class R>
STOPLINE_INLINE R idm_interaction(const R& speed_mps, const R& closing_mps, const R& gap_m, const R& standstill_gap_m,
                                  const R& growth_m, double closing_s2pm) {
    const R dynamic_m = growth_m + speed_mps * closing_mps * closing_s2pm;
    const R desired_m = standstill_gap_m + max_of(dynamic_m, R(0.0));
    return square(R(desired_m / max_of(gap_m, R(kMinIdmGap_m))));
}

// Returns (v / v_0)^4.
template <class R>
STOPLINE_INLINE R idm_free_term(const R& speed_mps, const R& desired_mps) {
    return square(square(R(speed_mps / max_of(desired_mps, R(0.1)))));
}

// Returns the acceleration of the IDM, m/s2.
inline double idm_acceleration_mps2(const IdmParameters& p, double speed_mps, double closing_mps, double gap_m,
                                    double desired_mps) {
    return p.acceleration_mps2 * (1.0 - idm_free_term(speed_mps, desired_mps) -
                                  idm_interaction(speed_mps, closing_mps, gap_m, p.standstill_gap_m,
                                                  p.time_gap_s * speed_mps, p.closing_s2pm));
}

// The IDM as a car-following model of the mesoscale mode. The concept CarFollowing (following_model.h) explains the
// functions.
struct Idm : IdmParameters {
    static constexpr std::array kNames{
        FollowingName{"idm", "the intelligent driver model of Treiber, Hennecke and Helbing"}};

    static Idm make(const FollowingSettings& settings, const MesoGap& gap) {
        return {idm_parameters(settings.meso.idm, gap.standstill_gap_m, gap.time_gap_s)};
    }

    double smallest_gap_m() const { return standstill_gap_m; }
    FollowingBraking braking() const { return {deceleration_mps2, kBrakingReaction_s}; }
    bool relays_starts() const { return false; }
    bool has_power_limit() const { return false; }
    bool leader_uses_following_speed() const { return true; }
    SumoFollowing in_sumo() const {
        return {"IDM", acceleration_mps2, deceleration_mps2, time_gap_s, standstill_gap_m, 0.0, true};
    }

    template <class R, class Random>
    STOPLINE_INLINE static R following_speed_mps(const Idm& k, const FollowingInputOf<R>& in, const Random& /*random*/,
                                                 double dt) {
        const R interaction =
            idm_interaction(in.speed_mps, R(in.speed_mps - in.leader_speed_mps), in.gap_m,
                            R(k.standstill_gap_m + in.extra_gap_m), R(k.time_gap_s * in.speed_mps), k.closing_s2pm);
        return in.speed_mps + k.acceleration_mps2 * dt * (1.0 - interaction);
    }

    template <class R>
    STOPLINE_INLINE static R leader_speed_mps(const Idm& /*k*/, const FollowingInputOf<R>& /*in*/,
                                              const R& following_mps, bool /*relays*/, bool /*uses_following_speed*/) {
        return following_mps;
    }

    template <bool power_limit, class R>
    STOPLINE_INLINE static R desired_speed_mps(const Idm& k, const FollowingInputOf<R>& in, const R& following_mps,
                                               double dt, const R& /*least_mps2*/) {
        return following_mps - k.acceleration_mps2 * dt * idm_free_term(in.speed_mps, in.limit_mps);
    }

    template <class R, class Random>
    STOPLINE_INLINE static R disturbed_speed_mps(const Idm& /*k*/, const R& bounded_mps, const Random& /*random*/,
                                                 double /*dt*/) {
        return bounded_mps;
    }
};

template <>
struct FollowingAt<1> {
    using Trait = Idm;
};

}  // namespace stopline
