// Human drivers: the human driver model (HDM) of Treiber, Kesting, Helbing 2006, "Delays, inaccuracies and anticipation
// in microscopic traffic models", Physica A 360. A driver accelerates as in the intelligent driver model (idm.h), but
// sees gap and closing speed with a delay and with errors:
//
//   reaction time    The driver sees the gap s and the closing speed dv as they were a reaction time tau ago. Temporal
//                    anticipation: the driver assumes that dv has not changed since, so the gap is now s - tau dv.
//   gap error        The driver estimates the gap s (1 + V_s w_s). V_s is the relative error.
//   closing error    The driver estimates the closing speed dv + r_c s w_v. r_c is the error of the inverse time to
//                    collision.
//
// In the source, w_s and w_v are Wiener processes with unit variance and a correlation time. Here they are functions of
// time, so that a driver needs no memory: each process has a random number at every multiple of the correlation time.
// It is interpolated between these numbers so that its variance is always 1. The errors are 0 at rest and grow with the
// speed up to kFullErrorSpeed_mps.
//
// Each driver has its own reaction time, uniform within reaction_s +- reaction_spread_s. Full dynamics stores the
// measurements of past steps, so a driver sees them tau late (sim/full_dynamics/human_perception.h). The mesoscale mode
// stores no past. There, a driver in motion has no delay, because the anticipation compensates for it (main result of
// the source). A driver at rest starts when the speed of its leader reaches tau x a_l, where a_l is the leader's
// acceleration. A leader that accelerates evenly has then moved for the time tau.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "driver/idm.h"

namespace stopline {

inline constexpr double kFullErrorSpeed_mps = 1.0;
inline constexpr double kErrorRange_m = 100.0;  // the closing error does not grow beyond this gap

// The reaction time of a driver. `u` is uniform in [0, 1).
template <class R>
STOPLINE_INLINE R reaction_time_s(const HumanSettings& h, const R& u) {
    return h.reaction_s + h.reaction_spread_s * (2.0 * u - 1.0);
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
// is the time. Number 0 gives the reaction time. The numbers 1, 3, 5, ... give the gap error, and 2, 4, 6, ... give the
// closing error.
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
struct Human : Idm {
    static constexpr std::array kNames{FollowingName{"human", "human drivers: idm with reaction time and errors"}};

    HumanSettings human;

    static Human make(const FollowingSettings& settings, const MesoGap& gap) {
        return {{idm_parameters(settings.human.idm, gap.standstill_gap_m, gap.time_gap_s)}, settings.human};
    }

    template <class R, class Random>
    STOPLINE_INLINE static R following_speed_mps(const Human& k, const FollowingInputOf<R>& in, const Random& random,
                                                 double dt) {
        const HumanView<R> exact{in.gap_m, R(in.speed_mps - in.leader_speed_mps)};
        const HumanView<R> seen = with_errors(k.human, exact, in.speed_mps, random);
        const R standstill_m = k.standstill_gap_m + in.extra_gap_m;
        const R interaction = idm_interaction(in.speed_mps, seen.closing_mps, seen.gap_m, standstill_m,
                                              R(k.time_gap_s * in.speed_mps), k.closing_s2pm);
        const R next = in.speed_mps + k.acceleration_mps2 * dt * (1.0 - interaction);
        const R reaction_s = reaction_time_s(k.human, R(random.driver(0)));
        const R waits = STOPLINE_FLAG(R, in.speed_mps <= 0.0) *
                        STOPLINE_FLAG(R, in.leader_speed_mps < reaction_s * in.leader_acceleration_mps2);
        return choose(waits, R(0.0), next);
    }
};

template <>
struct FollowingAt<2> {
    using Trait = Human;
};

}  // namespace stopline
