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
// Where the predecessor accelerates with a_l, v_l + T a_l stands for v_l (T: anticipation; 0 in the paper's models).
//
// Below 1 cm/s v' is 0. a(v) = a min(1, v_p / v): constant power beyond the speed v_p. The paper's models have none (v_p beyond all limits). xi is
// uniform in [0, 1); slow vehicles dawdle less, so that nobody is kept from starting (as in SUMO). Policies with a gap
// that grows above a switching speed (SWITCH) are the variant with s_0 raised by what the policy adds at the own speed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/random.h"
#include "base/simd.h"
#include "driver/driver_settings.h"

namespace stopline {

// One policy, ready for use. SI units.
struct Krauss {
    double acceleration_mps2 = 0.0;  // a
    double until_mps = 1e9;          // v_p
    double transient_gap_s2 = 0.0;   // times the predecessor's acceleration, where it accelerates: added to the gap
    double catch_up = 1.0;           // times the acceleration, close behind a predecessor
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

// The highest speed from which braking with b [m/s2] after the time tau [s] stops `gap_m` behind where a predecessor, braking alike from
// `ahead_mps`, would.
STOPLINE_INLINE double braking_speed_mps(double b, double tau, double gap_m, double ahead_mps) {
    const double bt = b * tau;
    const double square = bt * bt + ahead_mps * ahead_mps + 2.0 * b * gap_m;
    return std::sqrt(std::max(square, 0.0)) - bt;
}

// v_safe for a net gap; `more_m`: by how much the policy raises the gap at the own speed.
STOPLINE_INLINE double safe_speed_mps(const Krauss& k, double gap_m, double ahead_mps, double more_m) {
    const double beyond_m = gap_m - k.standstill_gap_m - more_m;
    const double braking = braking_speed_mps(k.deceleration_mps2, k.reaction_s, beyond_m - k.band_m, ahead_mps);
    const double close = beyond_m > -k.band_m ? ahead_mps : k.below_band * ahead_mps;
    return k.constant_distance && beyond_m <= 0.0 ? close : braking;
}

// Slower than a centimetre a second is standing: following would close the last of a gap ever more slowly and never end.
STOPLINE_INLINE double at_rest(double speed_mps) {
    constexpr double kRest_mps = 0.01;
    return speed_mps < kRest_mps ? 0.0 : speed_mps;
}

// What a vehicle's speed depends on.
struct KraussInput {
    double speed_mps;
    double gap_m;
    double ahead_mps;   // speed of the predecessor
    double ahead_mps2;  // its acceleration in the last step; 0 where it brakes
    double more_m;      // see safe_speed_mps
    double cap_mps;     // the limit, or what a stop line allows
};

// Whether the model's power is ever the limit: the same for all vehicles of a loop, and a division each that is spared.
inline bool has_power_limit(const Krauss& k) { return k.until_mps < 100.0; }

// `random`: in [0, 1). `power_limit`: see has_power_limit.
template <bool power_limit = true>
STOPLINE_INLINE double next_speed_mps(const Krauss& k, const KraussInput& in, double random, double dt) {
    const double more_m = in.more_m + k.transient_gap_s2 * in.ahead_mps2;
    const double ahead_mps = in.ahead_mps + k.anticipation_s * in.ahead_mps2;
    const double safe = safe_speed_mps(k, in.gap_m, ahead_mps, more_m);
    double share = 1.0;
    if constexpr (power_limit) share = std::min(1.0, k.until_mps / std::max(in.speed_mps, 1e-3));
    constexpr double kClose_m = 2.0;
    const bool close = in.gap_m - in.more_m < k.equilibrium_gap_m(in.speed_mps) + kClose_m;
    const double more = close ? k.catch_up : 1.0;
    const double faster = in.speed_mps + k.acceleration_mps2 * share * more * dt;
    // Models with anticipation or short gaps can ask for too little braking when a predecessor stops more suddenly than it would by
    // itself (at a conflict area): nobody drives further than to where the rear ahead was.
    const double touch = std::max(in.gap_m, 0.0) / dt;
    const double wanted = at_rest(std::min(std::min(std::min(safe, touch), faster), in.cap_mps));
    constexpr double kSlow_s = 1.0;  // vehicles slower than a x 1 s dawdle in proportion to their speed
    return wanted - k.dawdling * dt * random * std::min(wanted, k.acceleration_mps2 * kSlow_s);
}

// The model of a spacing policy: one with a time gap is a Krauss model, any other the variant with constant distance; what the
// policy's time and standstill gaps differ from those that the settings were calibrated with is added.
Krauss krauss_of(const MesoSettings& settings, const GapPolicySettings& policy);

}  // namespace stopline
