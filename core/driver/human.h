// Human drivers: the human driver model (HDM) of Treiber, Kesting, Helbing 2006, "Delays, inaccuracies and anticipation
// in microscopic traffic models", Physica A 360. A driver accelerates as in the intelligent driver model (idm.h), but
// sees gap and closing speed with a delay and with errors:
//
//   reaction time    The driver sees the gap s and the leader's speed as they were a reaction time tau ago. Temporal
//                    anticipation: the driver assumes that the leader's speed has not changed since. It knows its own
//                    motion (our choice; in the source, the closing speed is assumed not to have changed).
//   gap error        The driver estimates the gap s (1 + V_s w_s). V_s is the relative error.
//   closing error    The driver estimates the closing speed dv + r_c s w_v. r_c is the error of the inverse time to
//                    collision.
//   several leaders  The driver reacts to the n vehicles ahead: their terms (s* / s)^2 of the intelligent driver model
//                    are added. s is the sum of the net gaps up to a vehicle, and dv is the difference to its speed.
//                    s* is multiplied by c = 1 / sqrt(1 + 1/4 + ... + 1/n^2), so that the equilibrium gap is that of
//                    one leader. Without this spatial anticipation, platoons with a reaction time would be unstable.
//
// Our choice: the gap to the n-th vehicle counts as at least n times the gap to the leader. Otherwise a driver would
// keep a longer gap behind a platoon of automated vehicles with short gaps, or before a standing queue.
//
// In the source, w_s and w_v are Wiener processes with unit variance and a correlation time. Here they are functions of
// time, so that a driver needs no memory: each process has a random number at every multiple of the correlation time.
// It is interpolated between these numbers so that its variance is always 1. The errors are 0 at rest and grow with the
// speed up to kFullErrorSpeed_mps.
//
// Each driver has its own reaction time, uniform within reaction_s +- reaction_spread_s. Its reaction time at the start
// deviates from start_reaction_s by the same percentage. Full dynamics stores the measurements of past steps, so a
// driver sees them tau late, but at most as late as its own start (view_age_s()). The mesoscale mode stores no past.
// There, a moving driver sees its leader without delay and reacts to this leader only. Reason: the anticipation
// compensates for the delay (main result of the source).
//
// Start. A driver at rest behind its leader begins to accelerate one start reaction time after the leader has begun to
// move. The driver then drives off: for one further reaction time it accelerates as if there were no leader. This ends
// early if the leader is slower than the driver, or if the gap is shorter than the standstill gap. Reason: the
// acceleration of the intelligent driver model grows with the gap, so this model alone starts as late as measured
// drivers. With the waiting time in addition, the delay would count twice. Measured followers accelerate at once
// (data/startup/stuttgart_curve.csv). In full dynamics, the powertrain adds its delay. In the mesoscale mode,
// MesoSettings::start_delay_s replaces this delay.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "driver/idm.h"

namespace stopline {

inline constexpr double kFullErrorSpeed_mps = 1.0;
inline constexpr int kMaxAnticipatedVehicles = 10;
inline constexpr double kErrorRange_m = 100.0;  // the closing error does not grow beyond this gap

// Returns the reaction time of a driver while following. `u` is uniform in [0, 1).
template <class R>
STOPLINE_INLINE R reaction_time_s(const HumanSettings& h, const R& u) {
    return h.reaction_s + h.reaction_spread_s * (2.0 * u - 1.0);
}

// Returns the start reaction time of a driver whose reaction time while following is `reaction_s`.
template <class R>
STOPLINE_INLINE R start_reaction_s(const HumanSettings& h, const R& reaction_s) {
    return h.reaction_s > 0.0 ? R(reaction_s * (h.start_reaction_s / h.reaction_s)) : R(h.start_reaction_s);
}

// Returns 1 for a driver that drives off, else 0. `since_leader_start_s`: time since the leader began to move; 0 while
// it is stopped. `wait_s`: delay of the own start. `extra_gap_m`: net gap minus standstill gap.
template <class R>
STOPLINE_INLINE R is_driving_off(const R& since_leader_start_s, const R& wait_s, const R& reaction_s,
                                 const R& closing_mps, const R& extra_gap_m) {
    return STOPLINE_FLAG(R, since_leader_start_s > 0.0) * STOPLINE_FLAG(R, since_leader_start_s >= wait_s) *
           STOPLINE_FLAG(R, since_leader_start_s < wait_s + reaction_s) * STOPLINE_FLAG(R, closing_mps <= 0.0) *
           STOPLINE_FLAG(R, extra_gap_m >= 0.0);
}

// Highest value of VehicleArrays::start_ticks, the number of steps since the leader of a stopped driver began to move.
// A driver that has not stopped behind a leader has this value, too.
inline constexpr int kStartedLongAgo_ticks = 1 << 28;
// Our choice: a driver with a larger extra gap has not stopped because of its leader.
inline constexpr double kStoppedBehindLeader_m = 1.0;

// Returns the number of steps since the leader started, one step after it was `ticks`. Returns 0 while driver and
// leader are stopped and the extra gap is at most kStoppedBehindLeader_m. `extra_gap_m`: net gap minus standstill gap.
inline int next_start_ticks(int ticks, double speed_mps, double leader_speed_mps, double extra_gap_m) {
    const bool both_rest = speed_mps <= kMesoStopSpeed_mps && leader_speed_mps <= kMesoStopSpeed_mps;
    if (both_rest && extra_gap_m <= kStoppedBehindLeader_m) return 0;
    return ticks < kStartedLongAgo_ticks ? ticks + 1 : ticks;
}

// Returns true if the leader of a driver at rest has started, but less than `wait_s` ago.
inline bool waits_to_start(int start_ticks, double speed_mps, double wait_s, double step_s) {
    return speed_mps <= kMesoStopSpeed_mps && start_ticks > 0 && (start_ticks + 0.5) * step_s < wait_s;
}

// Returns the age of what a driver sees: the time since its own start, but at most its reaction time.
inline double view_age_s(double since_start_s, double reaction_s) {
    return since_start_s < 0.0 ? 0.0 : since_start_s < reaction_s ? since_start_s : reaction_s;
}

// Returns the factor c on the desired gap of a driver that reacts to `vehicles` vehicles ahead.
inline double several_leaders_factor(int vehicles) {
    double sum = 0.0;
    for (int n = 1; n <= vehicles; ++n) sum += 1.0 / square(static_cast<double>(n));
    return 1.0 / std::sqrt(sum);
}

// The two random numbers between which an error process is interpolated, and their weights.
struct ErrorKnots {
    std::uint64_t first;  // index of the earlier random number; the later one has the next index
    double first_weight, second_weight;
};
STOPLINE_INLINE ErrorKnots error_knots(double time_s, double correlation_s) {
    const double at_knot = time_s / correlation_s;
    const double share = at_knot - std::floor(at_knot);
    // The variance of the interpolated value is (1 - share)^2 + share^2 times that of the random numbers.
    const double norm = 1.0 / std::sqrt((1.0 - share) * (1.0 - share) + share * share);
    return {static_cast<std::uint64_t>(at_knot), (1.0 - share) * norm, share * norm};
}

// HumanView is what a driver sees of its leader.
template <class R>
struct HumanView {
    R gap_m, closing_mps;
};

// Returns the view with the estimation errors. `random.driver(n)` is random number n of the driver, `random.time_s()`
// is the time, and `random.since_leader_start_s()` the time since the vehicle ahead began to move. Number 0 gives the
// reaction time. The numbers 1, 3, 5, ... give the gap error, and 2, 4, 6, ... give the closing error.
template <class R, class Random>
STOPLINE_INLINE HumanView<R> with_errors(const HumanSettings& h, const HumanView<R>& exact, const R& speed_mps,
                                         const Random& random) {
    if (h.gap_error == 0.0 && h.closing_error_1ps == 0.0) return exact;
    const ErrorKnots knots = error_knots(random.time_s(), h.error_time_s);
    const auto error = [&](std::uint64_t process) STOPLINE_INLINE_LAMBDA -> R {
        const double scale = std::sqrt(12.0);  // uniform numbers have the variance 1 / 12
        const R first = random.driver(2 * knots.first + process) - 0.5;
        const R second = random.driver(2 * knots.first + 2 + process) - 0.5;
        return scale * (knots.first_weight * first + knots.second_weight * second);
    };
    const R share = min_of(speed_mps * (1.0 / kFullErrorSpeed_mps), R(1.0));
    const R gap_m = exact.gap_m * (1.0 + h.gap_error * share * error(1));
    const R error_mps = h.closing_error_1ps * min_of(exact.gap_m, R(kErrorRange_m)) * share * error(2);
    return {gap_m, exact.closing_mps + error_mps};
}

// Human drivers as a car-following model of the mesoscale mode. The concept CarFollowing (following_model.h) explains
// the functions. The policy gives the standstill gap and the time gap, the driver all other parameters.
// collect_moving_blocks() holds a stopped driver until its waiting time is over.
struct Human : Idm {
    static constexpr std::array kNames{FollowingName{"human", "human drivers: idm with reaction time and errors"}};

    HumanSettings human;
    double powertrain_delay_s = 0.0;

    static Human make(const FollowingSettings& settings, const MesoGap& gap) {
        return {{idm_parameters(settings.human.idm, gap.standstill_gap_m, gap.time_gap_s)},
                settings.human,
                settings.meso.start_delay_s};
    }

    template <class R, class Random>
    STOPLINE_INLINE static R following_speed_mps(const Human& k, const FollowingInputOf<R>& in, const Random& random,
                                                 double dt) {
        const HumanView<R> exact{in.gap_m, R(in.speed_mps - in.leader_speed_mps)};
        const HumanView<R> seen = with_errors(k.human, exact, in.speed_mps, random);
        const R standstill_m = k.standstill_gap_m + in.extra_gap_m;
        const R interaction = idm_interaction(in.speed_mps, seen.closing_mps, seen.gap_m, standstill_m,
                                              R(k.time_gap_s * in.speed_mps), k.closing_s2pm);
        const R reaction_s = reaction_time_s(k.human, R(random.driver(0)));
        const R wait_s = start_reaction_s(k.human, reaction_s) + k.powertrain_delay_s;
        const R drives_off = is_driving_off(R(random.since_leader_start_s()), wait_s, reaction_s,
                                            R(in.speed_mps - in.leader_speed_mps), R(in.gap_m - k.standstill_gap_m));
        return in.speed_mps + k.acceleration_mps2 * dt * (1.0 - interaction * (1.0 - drives_off));
    }
};

template <>
struct FollowingAt<2> {
    using Trait = Human;
};

}  // namespace stopline
