// Car following of the mesoscale mode: computes the speed of the next step from the state at the start of the step.
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

#include <array>
#include <cmath>
#include <utility>

#include "base/simd/arithmetic.h"
#include "base/simd/simd.h"
#include "base/speed_thresholds.h"
#include "driver/acceleration_laws.h"
#include "driver/driver_settings.h"

namespace stopline {

// The model of one spacing policy, ready for use. SI units.
struct Krauss {
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

    double equilibrium_gap_m(double speed_mps) const { return standstill_gap_m + band_m + reaction_s * speed_mps; }
};

// The parameters of several vehicles, which may have different policies. The members mean the same as in Krauss.
template <class R>
struct KraussPerVehicle {
    R acceleration_mps2, constant_power_speed_mps, transient_gap_s2, catch_up_factor, gap_tracking, anticipation_s;
    R deceleration_mps2, reaction_s, standstill_gap_m, dawdling;
    decltype(std::declval<R>() < std::declval<R>()) constant_distance;
    R band_m, below_band_speed_share;
};

// The functions below compute one vehicle or several at a time (base/simd/simd.h). `Model` is Krauss or
// KraussPerVehicle.

// Returns the highest speed from which a vehicle can stop behind its leader. The leader brakes with b [m/s2] at once,
// the vehicle brakes with b after the time tau [s]. `gap_m` is the part of the net gap that the vehicle may use up.
template <class R, class Parameter>
STOPLINE_INLINE R braking_speed_mps(const Parameter& b, const Parameter& tau, const R& gap_m,
                                    const R& leader_speed_mps) {
    const auto bt = b * tau;
    const R square = bt * bt + leader_speed_mps * leader_speed_mps + 2.0 * b * gap_m;
    return square_root(max_of(square, R(0.0))) - bt;
}

// Returns v_safe for a net gap. `extra_gap_m` is added to s_0: the extra gap of the policy (MesoGap) at the
// current speed.
template <class R, class Model>
STOPLINE_INLINE R safe_speed_mps(const Model& k, const R& gap_m, const R& leader_speed_mps, const R& extra_gap_m) {
    const R spare_gap_m = gap_m - k.standstill_gap_m - extra_gap_m;
    const R braking = braking_speed_mps(k.deceleration_mps2, k.reaction_s, R(spare_gap_m - k.band_m), leader_speed_mps);
    const R close = select(spare_gap_m > -k.band_m, leader_speed_mps, R(k.below_band_speed_share * leader_speed_mps));
    return select(k.constant_distance, select(spare_gap_m <= 0.0, close, braking), braking);
}

// Returns the speed, or 0 if it is below 1 cm/s. Without this rule, a follower would close its gap ever more slowly and
// never come to rest.
template <class R>
STOPLINE_INLINE R snap_to_standstill(const R& speed_mps) {
    return select(speed_mps < kMesoStopSpeed_mps, R(0.0), speed_mps);
}

// The state from which the next speed of a vehicle is computed.
template <class R>
struct KraussInputOf {
    R speed_mps;
    R gap_m;  // net gap to the leader
    R leader_speed_mps;
    R leader_acceleration_mps2;  // in the previous step; 0 if the leader brakes
    R extra_gap_m;               // see safe_speed_mps()
    R speed_cap_mps;             // highest speed that the speed limit and the stop line allow
};
using KraussInput = KraussInputOf<double>;

// Returns v_safe, reduced so that the vehicle keeps its time gap. v_safe allows a shorter gap while the leader is
// faster, because a faster leader needs longer to stop. Full tracking (gap_tracking = 1) limits the speed to
// (s - s_0) / tau. With partial tracking the speed lies between that limit and v_safe.
template <class R, class Model>
STOPLINE_INLINE R track_time_gap(const Model& k, const KraussInputOf<R>& in, const R& extra_gap_m, const R& safe_mps) {
    const R time_gap_mps = (in.gap_m - k.standstill_gap_m - extra_gap_m) * (1.0 / max_of(R(k.reaction_s), R(0.05)));
    const R reduction_mps = k.gap_tracking * max_of(safe_mps - time_gap_mps, R(0.0));
    return select(k.constant_distance, safe_mps, R(safe_mps - reduction_mps));
}

// Returns true if constant power can limit the acceleration. If it cannot, the kernels save a division per vehicle.
inline bool has_power_limit(const Krauss& k) { return k.constant_power_speed_mps < 100.0; }

// Returns v_safe for the anticipated speed of the leader.
template <class R, class Model>
STOPLINE_INLINE R anticipated_safe_speed_mps(const Model& k, const KraussInputOf<R>& in, const R& extra_gap_m) {
    return safe_speed_mps(k, in.gap_m, R(in.leader_speed_mps + k.anticipation_s * in.leader_acceleration_mps2),
                          extra_gap_m);
}
// Returns v_safe for the anticipated speed of the leader, with the transient gap added to the extra gap.
template <class R, class Model>
STOPLINE_INLINE R anticipated_safe_speed_mps(const Model& k, const KraussInputOf<R>& in) {
    return anticipated_safe_speed_mps(k, in, R(in.extra_gap_m + k.transient_gap_s2 * in.leader_acceleration_mps2));
}

// Returns the speed of the next step. `safe_mps` is the result of anticipated_safe_speed_mps(), `random` is uniform in
// [0, 1), and `power_limit` is the result of has_power_limit(). If `power_limit` is true, constant power can lower the
// maximum acceleration, but not below `least_mps2`. v_safe cannot reduce the speed below `lowest_mps`. A lower speed
// results only if the vehicle must avoid contact with the leader, or if in.speed_cap_mps is lower. v_safe is below
// `lowest_mps` only after lane changes.
template <bool power_limit, class R, class Model>
STOPLINE_INLINE R speed_after_mps(const Model& k, const KraussInputOf<R>& in, const R& safe_mps, const R& random,
                                  double dt, const R& lowest_mps = R(0.0), const R& least_mps2 = R(0.0)) {
    const R extra_gap_m = in.extra_gap_m + k.transient_gap_s2 * in.leader_acceleration_mps2;
    const R safe = track_time_gap(k, in, extra_gap_m, safe_mps);
    R acceleration = k.acceleration_mps2;
    if constexpr (power_limit)
        acceleration = max_of(
            acceleration * min_of(R(1.0), R(k.constant_power_speed_mps / max_of(in.speed_mps, R(1e-3)))), least_mps2);
    constexpr double kCatchUp_m = 2.0;  // catch_up_factor applies up to this excess over the equilibrium gap
    const R equilibrium_m = k.standstill_gap_m + k.band_m + k.reaction_s * in.speed_mps;
    const R factor = select(in.gap_m - in.extra_gap_m < equilibrium_m + kCatchUp_m, R(k.catch_up_factor), R(1.0));
    const R accelerated = in.speed_mps + acceleration * factor * dt;
    // The vehicle moves at most to the current position of its leader's rear. Models with anticipation or short gaps
    // can brake too little if the leader stops harder than the model expects, such as before a conflict area.
    const R contact = max_of(in.gap_m, R(0.0)) * (1.0 / dt);
    const R desired =
        snap_to_standstill(min_of(min_of(max_of(min_of(safe, accelerated), lowest_mps), contact), in.speed_cap_mps));
    constexpr double kSlow_s = 1.0;  // vehicles slower than a x 1 s dawdle in proportion to their speed
    return desired - k.dawdling * dt * random * min_of(desired, R(k.acceleration_mps2 * kSlow_s));
}

// The acceleration of platoon leaders as a function of speed. It is constant within each bin and beyond the last bin.
struct LeaderProfile {
    static constexpr int kBins = 64;
    double bins_per_mps = 0.0;  // 0: no profile
    std::array<double, kBins> acceleration_mps2{};
};
// Converts leader_profile_mps and leader_profile_mps2 of the settings into bins. Each bin gets the acceleration of the
// listed speed that is nearest to the middle of the bin. If the settings list no speeds, bins_per_mps is 0.
LeaderProfile leader_profile(const MesoSettings& settings);

// Returns, by speed, the lowest accelerations on lanes whose speed limit is above the limit for which the models were
// calibrated. The values come from DriverTables::power_mps2.
LeaderProfile power_profile(const DriverTables& driver);

// Returns the next speed of one vehicle.
inline double next_speed_mps(const Krauss& k, const KraussInput& in, double random, double dt) {
    return speed_after_mps<true>(k, in, anticipated_safe_speed_mps(k, in), random, dt);
}

// The desired gap of a spacing policy in the mesoscale mode: standstill gap + time gap x speed + extra gap. The extra
// gap is a function of the speed. It is 0 at rest.
struct MesoGap {
    enum class Model {
        constant_distance,  // equation (1)
        time_gap            // Krauss
    };
    Model model = Model::constant_distance;
    double standstill_gap_m = 0.0;
    double time_gap_s = 0.0;     // 0 for Model::constant_distance
    bool has_extra_gap = false;  // false: the extra gap is 0 at every speed

    // Returns the gap without the extra gap.
    double gap_m(double speed_mps) const { return standstill_gap_m + time_gap_s * speed_mps; }
};

// Makes the model of a spacing policy. If the time gap or the standstill gap of the policy differs from the calibrated
// one, tau or s_0 changes by the difference.
Krauss make_krauss_model(const MesoSettings& settings, const MesoGap& gap);

}  // namespace stopline
