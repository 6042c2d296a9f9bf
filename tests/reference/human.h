// Human drivers of the reference engine: reaction time, and what a driver sees of its leader. The equations are those
// of the comments in core/driver/human.h and core/driver/idm.h.
#pragma once

#include "reference/world.h"

namespace stopline::reference_engine {

// HumanView is what a driver sees of its leader.
struct HumanView {
    double gap_m = 0.0;
    double closing_mps = 0.0;
};

// The random numbers of one driver.
struct DriverRandom {
    std::uint64_t key = 0;
    int vehicle = 0;
    double number(std::uint64_t n) const { return keyed_uniform(key, vehicle, n); }
};

// The reaction times of one driver: while following, and at the start of the vehicle ahead.
struct HumanTimes {
    double reaction_s = 0.0;
    double start_s = 0.0;
};

inline HumanTimes human_times(const HumanSettings& h, const DriverRandom& random) {
    const double reaction_s = h.reaction_s + h.reaction_spread_s * (2.0 * random.number(0) - 1.0);
    return {reaction_s, h.reaction_s > 0.0 ? h.start_reaction_s * reaction_s / h.reaction_s : h.start_reaction_s};
}

// Counts the steps since the vehicle ahead began to move, and decides whether the driver waits to start. The count
// begins anew while both stand and the driver is at most 1 m behind its standstill gap.
inline void update_start(const HumanTimes& times, double extra_gap_m, double leader_mps, double step_s, Vehicle& v) {
    const bool is_at_rest = v.speed_mps <= kMesoStopSpeed_mps;
    const bool both_rest = is_at_rest && leader_mps <= kMesoStopSpeed_mps;
    if (both_rest && extra_gap_m <= 1.0) {
        v.start_steps = 0;
    } else {
        v.start_steps = std::min(v.start_steps + 1, 1 << 28);
    }
    v.waits_to_start = is_at_rest && v.start_steps > 0 && (v.start_steps + 0.5) * step_s < times.start_s;
}

// Returns true if the driver drives off: it has started, its reaction time has not passed since then, the vehicle ahead
// is not slower, and the gap is not shorter than the standstill gap.
inline bool drives_off(const HumanTimes& times, double since_leader_start_s, double closing_mps, double extra_gap_m) {
    const double since_start_s = since_leader_start_s - times.start_s;
    return since_leader_start_s > 0.0 && since_start_s >= 0.0 && since_start_s < times.reaction_s &&
           closing_mps <= 0.0 && extra_gap_m >= 0.0;
}

// Returns an error process at a time. At each multiple of the correlation time it has a random number with mean 0 and
// variance 1. Between these times it is interpolated such that its variance stays 1. `process`: 1 or 2.
inline double error_at(const HumanSettings& h, const DriverRandom& random, double time_s, std::uint64_t process) {
    const double periods = std::floor(time_s / h.error_time_s);
    const double share = time_s / h.error_time_s - periods;
    const auto value = [&](double period) {
        return std::sqrt(12.0) * (random.number(2 * static_cast<std::uint64_t>(period) + process) - 0.5);
    };
    return ((1.0 - share) * value(periods) + share * value(periods + 1.0)) / std::hypot(1.0 - share, share);
}

// Returns the view with the estimation errors of the driver. They are 0 at rest and grow with the speed up to 1 m/s.
inline HumanView estimated(const HumanSettings& h, const HumanView& exact, double speed_mps, const DriverRandom& random,
                           double time_s) {
    constexpr double kFullErrorSpeed_mps = 1.0;
    constexpr double kErrorRange_m = 100.0;
    const double share = std::min(speed_mps / kFullErrorSpeed_mps, 1.0);
    HumanView seen = exact;
    seen.gap_m *= 1.0 + h.gap_error * share * error_at(h, random, time_s, 1);
    seen.closing_mps +=
        h.closing_error_1ps * std::min(exact.gap_m, kErrorRange_m) * share * error_at(h, random, time_s, 2);
    return seen;
}

// Returns (s* / s)^2 of the intelligent driver model. `growth_m` is T v.
inline double idm_interaction(const IdmSettings& idm, double speed_mps, const HumanView& view, double standstill_gap_m,
                              double growth_m) {
    constexpr double kMinGap_m = 0.1;
    const double dynamic_m =
        growth_m + speed_mps * view.closing_mps / (2.0 * std::sqrt(idm.acceleration_mps2 * idm.deceleration_mps2));
    const double ratio = (standstill_gap_m + std::max(dynamic_m, 0.0)) / std::max(view.gap_m, kMinGap_m);
    return ratio * ratio;
}

// Returns (v / v_0)^4.
inline double idm_free_term(double speed_mps, double desired_mps) {
    return std::pow(speed_mps / std::max(desired_mps, 0.1), 4);
}

}  // namespace stopline::reference_engine
