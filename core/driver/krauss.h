// Car following of the mesoscale mode: the speed of the next step from the state at the beginning of this one.
//
// Krauss (1998, "Microscopic modeling of traffic flow", chapter 5), with the safe speed solved for the gap as SUMO uses it:
//
//   v_safe = -b tau + sqrt(b^2 tau^2 + v_l^2 + 2 b (s - s_0))
//
// and the paper's variant for constant distance, equation (1) with the lost plus sign restored: as above with s_0 + s_t in
// place of s_0 where s > s_0; v_l for s_0 - s_t < s <= s_0; d v_l below. It jumps at s_0, as printed. Both stand still at
// s_0 (+ s_t) and follow at speed v in the gap s_0 (+ s_t) + tau v.
//
//   v' = min(v_safe, v + a(v) dt, cap),  v <- max(0, v' - sigma dt xi min(v', a 1 s)),  x <- x + v dt
//
// Where the predecessor accelerates with a_l, v_l + T a_l stands for v_l (T: anticipation; 0 in the paper's models). Models with a time
// gap can track it: see tracked (not in the paper's).
//
// Below 1 cm/s v' is 0. a(v) = a min(1, v_p / v): constant power beyond the speed v_p. The paper's models have none (v_p beyond all limits). xi is
// uniform in [0, 1); slow vehicles dawdle less, so that nobody is kept from starting (as in SUMO). Policies with a gap
// that grows above a switching speed (SWITCH) are the variant with s_0 raised by what the policy adds at the own speed.
#pragma once

#include <array>
#include <cmath>
#include <utility>

#include "base/arithmetic.h"
#include "base/simd.h"
#include "driver/driver_settings.h"

namespace stopline {

// One policy, ready for use. SI units.
struct Krauss {
    double acceleration_mps2 = 0.0;  // a
    double until_mps = 1e9;          // v_p
    double transient_gap_s2 = 0.0;   // times the predecessor's acceleration, where it accelerates: added to the gap
    double catch_up = 1.0;           // times the acceleration, close behind a predecessor
    double tracking = 0.0;           // of the time gap, 0 .. 1: see tracked
    double anticipation_s = 0.0;     // the predecessor is seen as fast as it will be then, if it goes on accelerating
    double deceleration_mps2 = 0.0;  // b
    double reaction_s = 0.0;         // tau
    double standstill_gap_m = 0.0;   // s_0
    double dawdling = 0.0;           // sigma, 0 .. 1
    bool constant_distance = false;  // equation (1); else Krauss
    double band_m = 0.0;             // s_t; 0 with Krauss
    double below_band = 1.0;         // d

    double equilibrium_gap_m(double speed_mps) const { return standstill_gap_m + band_m + reaction_s * speed_mps; }
};

// The same for several vehicles side by side, each with the parameters of its policy; names as above.
template <class R>
struct KraussSideBySide {
    R acceleration_mps2, until_mps, transient_gap_s2, catch_up, tracking, anticipation_s, deceleration_mps2, reaction_s;
    R standstill_gap_m, dawdling;
    decltype(std::declval<R>() < std::declval<R>()) constant_distance;
    R band_m, below_band;
};

// The equations, for plain numbers or several vehicles at a time (base/simd.h). Model: Krauss or KraussSideBySide.

// The highest speed from which braking with b [m/s2] after the time tau [s] stops `gap_m` behind where a predecessor, braking alike from
// `ahead_mps`, would.
template <class R, class Parameter>
STOPLINE_INLINE R braking_speed_mps(const Parameter& b, const Parameter& tau, const R& gap_m, const R& ahead_mps) {
    const auto bt = b * tau;
    const R square = bt * bt + ahead_mps * ahead_mps + 2.0 * b * gap_m;
    return square_root(greater(square, R(0.0))) - bt;
}

// v_safe for a net gap; `more_m`: by how much the policy raises the gap at the own speed.
template <class R, class Model>
STOPLINE_INLINE R safe_speed_mps(const Model& k, const R& gap_m, const R& ahead_mps, const R& more_m) {
    const R beyond_m = gap_m - k.standstill_gap_m - more_m;
    const R braking = braking_speed_mps(k.deceleration_mps2, k.reaction_s, R(beyond_m - k.band_m), ahead_mps);
    const R close = select(beyond_m > -k.band_m, ahead_mps, R(k.below_band * ahead_mps));
    return select(k.constant_distance, select(beyond_m <= 0.0, close, braking), braking);
}

// Slower than a centimetre a second is standing: following would close the last of a gap ever more slowly and never end.
template <class R>
STOPLINE_INLINE R at_rest(const R& speed_mps) {
    constexpr double kRest_mps = 0.01;
    return select(speed_mps < kRest_mps, R(0.0), speed_mps);
}

// What a vehicle's speed depends on.
template <class R>
struct KraussInputOf {
    R speed_mps;
    R gap_m;
    R ahead_mps;   // speed of the predecessor
    R ahead_mps2;  // its acceleration in the last step; 0 where it brakes
    R more_m;      // see safe_speed_mps
    R cap_mps;     // the limit, or what a stop line allows
};
using KraussInput = KraussInputOf<double>;

// v_safe lets a vehicle come nearer than its time gap while the predecessor draws away, since that would need longer to stop. Who
// tracks the gap is no faster than (s - s_0) / tau: with tracking < 1 a share of the way from v_safe down to that.
template <class R, class Model>
STOPLINE_INLINE R tracked(const Model& k, const KraussInputOf<R>& in, const R& more_m, const R& safe_mps) {
    const R keeps_mps = (in.gap_m - k.standstill_gap_m - more_m) * (1.0 / greater(R(k.reaction_s), R(0.05)));
    const R less_mps = k.tracking * greater(safe_mps - keeps_mps, R(0.0));
    return select(k.constant_distance, safe_mps, R(safe_mps - less_mps));
}

// Whether the model's power is ever the limit: the same for all vehicles of a loop, and a division each that is spared.
inline bool has_power_limit(const Krauss& k) { return k.until_mps < 100.0; }

// v_safe with regard to what the predecessor is about to do.
template <class R, class Model>
STOPLINE_INLINE R foreseen_safe_mps(const Model& k, const KraussInputOf<R>& in, const R& more_m) {
    return safe_speed_mps(k, in.gap_m, R(in.ahead_mps + k.anticipation_s * in.ahead_mps2), more_m);
}
template <class R, class Model>
STOPLINE_INLINE R foreseen_safe_mps(const Model& k, const KraussInputOf<R>& in) {
    return foreseen_safe_mps(k, in, R(in.more_m + k.transient_gap_s2 * in.ahead_mps2));
}

// `safe_mps`: foreseen_safe_mps. `random`: in [0, 1). `power_limit`: see has_power_limit.
// `lowest_mps`: nobody brakes to less but to avoid touching; Krauss's models ask for no such braking unless somebody changed lanes.
template <bool power_limit, class R, class Model>
STOPLINE_INLINE R speed_after_mps(const Model& k, const KraussInputOf<R>& in, const R& safe_mps, const R& random,
                                  double dt, const R& lowest_mps = R(0.0)) {
    const R more_m = in.more_m + k.transient_gap_s2 * in.ahead_mps2;
    const R safe = tracked(k, in, more_m, safe_mps);
    R acceleration = k.acceleration_mps2;
    if constexpr (power_limit)
        acceleration = acceleration * lesser(R(1.0), R(k.until_mps / greater(in.speed_mps, R(1e-3))));
    constexpr double kClose_m = 2.0;
    const R equilibrium_m = k.standstill_gap_m + k.band_m + k.reaction_s * in.speed_mps;
    const R more = select(in.gap_m - in.more_m < equilibrium_m + kClose_m, R(k.catch_up), R(1.0));
    const R faster = in.speed_mps + acceleration * more * dt;
    // Models with anticipation or short gaps can ask for too little braking when a predecessor stops more suddenly than it would by
    // itself (at a conflict area): nobody drives further than to where the rear ahead was.
    const R touch = greater(in.gap_m, R(0.0)) * (1.0 / dt);
    const R wanted = at_rest(lesser(lesser(greater(lesser(safe, faster), lowest_mps), touch), in.cap_mps));
    constexpr double kSlow_s = 1.0;  // vehicles slower than a x 1 s dawdle in proportion to their speed
    return wanted - k.dawdling * dt * random * lesser(wanted, R(k.acceleration_mps2 * kSlow_s));
}

// Acceleration of platoon leaders over speed, constant in bins from 0 on and beyond the last.
struct LeaderProfile {
    static constexpr int kBins = 64;
    double bins_per_mps = 0.0;  // 0: none
    std::array<double, kBins> acceleration_mps2{};
};
LeaderProfile leader_profile(const MesoSettings& settings);

// For one vehicle.
inline double next_speed_mps(const Krauss& k, const KraussInput& in, double random, double dt) {
    return speed_after_mps<true>(k, in, foreseen_safe_mps(k, in), random, dt);
}

// The model of a spacing policy: one with a time gap is a Krauss model, any other the variant with constant distance; what the
// policy's time and standstill gaps differ from those that the settings were calibrated with is added.
Krauss krauss_of(const MesoSettings& settings, const GapPolicySettings& policy);

}  // namespace stopline
