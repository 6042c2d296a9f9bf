// The mesoscale mode of the reference engine: the speed of the next step. The equations are those of the comments in
// core/driver/krauss.h and core/driver/driver_settings.h.
#pragma once

#include "base/random.h"
#include "base/speed_thresholds.h"
#include "reference/human.h"
#include "reference/powertrain.h"
#include "reference/world.h"

namespace stopline::reference_engine {

// The car-following model of the vehicles with one policy.
struct MesoPolicy {
    const GapPolicy* policy = nullptr;
    DriverSettings driver;
    double maximum_mps = kNoLimit;  // speed limiter of the vehicle
    // Highest acceleration by speed, in bins; empty: the car-following model alone limits the acceleration.
    std::vector<double> fastest_mps2;
    bool is_idm = false;    // true: the intelligent driver model; false: a model of the Krauss family
    bool is_human = false;  // the intelligent driver model with reaction time and errors
    IdmSettings idm;
    KraussSettings settings;
    bool constant_distance = false;  // true: equation (1) of the paper; false: Krauss
    double s0_m = 0.0;
    double tau_s = 0.0;
    double band_m = 0.0;      // s_t of equation (1), 0 for the other models
    double below_band = 1.0;  // d of equation (1)

    // Returns the gap that the law adds to standstill gap and time gap.
    double extra_gap_m(double speed_mps) const {
        return policy->meso.has_extra_gap ? law_gap(*policy, speed_mps).gap_m - policy->meso.standstill_gap_m -
                                                policy->meso.time_gap_s * speed_mps
                                          : 0.0;
    }
    double equilibrium_gap_m(double speed_mps) const { return s0_m + band_m + tau_s * speed_mps; }
    // Returns the deceleration that the model expects, and the reaction time of a braking before a stop line.
    double braking_mps2() const { return is_idm ? idm.deceleration_mps2 : settings.deceleration_mps2; }
    double braking_reaction_s() const { return is_idm ? 0.5 : tau_s; }
};

// All constants of the mesoscale mode.
struct MesoModel {
    MesoSettings settings;
    DriverSettings driver;  // that of the first policy
    std::vector<MesoPolicy> policies;
    std::vector<double> leader_bins_mps2;  // acceleration of platoon leaders by speed; empty: no profile
    double leader_bins_per_mps = 0.0;
    std::vector<double> power_bins_mps2;  // lower bound of the acceleration on fast roads, by speed
    double power_bins_per_mps = 0.0;
    double step_s = 0.0;
    std::uint64_t dawdling_key = 0;
    std::uint64_t driver_key = 0;
    bool bounds_followers_by_power = true;
    double hardest_mps2 = kNoLimit;  // highest deceleration behind a leader

    double free_limit_mps(const Lane& lane, const Vehicle& v) const {
        const double maximum_mps = policies[static_cast<std::size_t>(v.policy)].maximum_mps;
        return std::min(settings.speed_factor * lane.limit_mps, maximum_mps);
    }
};

inline constexpr double kFastestTop_mps = 40.0;  // highest speed of MesoPolicy::fastest_mps2

inline MesoPolicy make_meso_policy(const MesoSettings& settings, const GapPolicy& policy) {
    MesoPolicy result;
    result.policy = &policy;
    result.is_human = policy.meso.family == kHumanFamily;
    result.is_idm = result.is_human || policy.meso.family == "idm";
    if (result.is_idm) {
        result.idm = settings.idm;
        result.s0_m = policy.meso.standstill_gap_m;
        result.tau_s = policy.meso.time_gap_s;
        return result;
    }
    result.constant_distance = policy.meso.family == kConstantDistanceFamily;
    result.settings = result.constant_distance ? settings.constant_distance : settings.constant_time;
    result.s0_m =
        result.settings.standstill_gap_m + policy.meso.standstill_gap_m - settings.calibrated_standstill_gap_m;
    result.tau_s = result.settings.reaction_s;
    if (result.constant_distance) {
        result.band_m = settings.band_m;
        result.below_band = settings.below_band_speed_share;
    } else {
        result.tau_s = std::max(result.tau_s + policy.meso.time_gap_s - settings.calibrated_time_gap_s, 0.0);
    }
    return result;
}

// Sets the tables of MesoModel. They hold one acceleration for each bin of speeds.
inline void tabulate_profiles(const VehicleModel& vehicle, MesoModel& model) {
    constexpr std::size_t kBins = 64;
    const std::vector<double>& speeds = model.settings.leader_profile_mps;
    if (!speeds.empty()) {
        model.leader_bins_per_mps = (kBins - 0.5) / std::max(speeds.back(), 1.0);
        for (std::size_t bin = 0; bin < kBins; ++bin) {
            const double middle_mps = (static_cast<double>(bin) + 0.5) / model.leader_bins_per_mps;
            const auto nearest = std::min_element(speeds.begin(), speeds.end(), [&](double a, double b) {
                return std::abs(a - middle_mps) < std::abs(b - middle_mps);
            });
            model.leader_bins_mps2.push_back(
                model.settings.leader_profile_mps2[static_cast<std::size_t>(nearest - speeds.begin())]);
        }
    }
    const GridCurve power = power_curve(vehicle, model.driver.free_drive.power_share);
    model.power_bins_per_mps = kBins / kPowerTop_mps;
    for (std::size_t bin = 0; bin < kBins; ++bin) {
        model.power_bins_mps2.push_back(power.at((static_cast<double>(bin) + 0.5) / model.power_bins_per_mps));
    }
}

inline double bin_value(const std::vector<double>& bins, double bins_per_mps, double speed_mps) {
    return bins[std::min(static_cast<std::size_t>(std::max(speed_mps * bins_per_mps, 0.0)), bins.size() - 1)];
}

// Returns the highest speed from which a vehicle can stop behind its leader, which has the speed v_l:
//     -b tau + sqrt((b tau)^2 + v_l^2 + 2 b gap)
inline double krauss_speed_mps(double b, double tau_s, double gap_m, double leader_mps) {
    const double bt = b * tau_s;
    return std::sqrt(std::max(bt * bt + leader_mps * leader_mps + 2.0 * b * gap_m, 0.0)) - bt;
}

// Returns v_safe. `extra_gap_m` is added to s_0.
inline double meso_safe_speed_mps(const MesoPolicy& p, double gap_m, double leader_mps, double extra_gap_m) {
    const double spare_m = gap_m - p.s0_m - extra_gap_m;
    if (p.constant_distance && spare_m <= -p.band_m) return p.below_band * leader_mps;
    if (p.constant_distance && spare_m <= 0.0) return leader_mps;
    return krauss_speed_mps(p.settings.deceleration_mps2, p.tau_s, spare_m - p.band_m, leader_mps);
}

inline double snapped(double speed_mps) { return speed_mps < kMesoStopSpeed_mps ? 0.0 : speed_mps; }

// Returns the highest speed of the next step before a lower speed limit; infinity if no lower limit is ahead. The
// vehicle follows the braking curve v^2 = v_end^2 + 2 b distance.
inline double speed_before_lower_limit_mps(const MesoModel& m, const Lane& lane, const Vehicle& v) {
    if (v.end_speed_mps == kNoLimit) return kNoLimit;
    const double b = m.policies[static_cast<std::size_t>(v.policy)].driver.free_drive.deceleration_mps2;
    const double distance_m = std::max(lane.next_limit_m - v.position_m, 0.0);
    const double allowed_mps = std::sqrt(v.end_speed_mps * v.end_speed_mps + 2.0 * b * distance_m);
    const double share = std::min(m.settings.turn_gain_1ps * m.step_s, 1.0);
    double next_mps = allowed_mps;
    if (share < 1.0) {
        next_mps =
            v.speed_mps + share * (allowed_mps - v.speed_mps) - b * m.step_s * v.speed_mps / std::max(allowed_mps, 1.0);
    }
    return std::max(next_mps, v.speed_mps - m.driver.cacc.deceleration_emergency_mps2 * m.step_s);
}

// Returns the highest speed of the next step for a vehicle that must stop at a position of its lane.
inline double stopping_speed_mps(const MesoModel& m, const Vehicle& v, double position_m) {
    const MesoPolicy& p = m.policies[static_cast<std::size_t>(v.policy)];
    const double b = std::min(p.braking_mps2(), p.driver.stop.deceleration_mps2);
    const double stop_mps = krauss_speed_mps(b, p.braking_reaction_s(), std::max(position_m - v.position_m, 0.0), 0.0);
    return std::max(stop_mps, v.speed_mps - p.driver.cacc.deceleration_emergency_mps2 * m.step_s);
}

// Returns the highest speed of the next step that the speed limits allow. For a vehicle without leader, the law of free
// driving limits the speed, too.
inline double highest_speed_mps(const MesoModel& m, const Lane& lane, const Vehicle& v, bool has_leader) {
    const double limit_mps = m.free_limit_mps(lane, v);
    const double share = std::min(m.settings.speed_gain_1ps * m.step_s, 1.0);
    const double emergency_mps = m.driver.cacc.deceleration_emergency_mps2 * m.step_s;
    double highest_mps = v.speed_mps + share * (limit_mps - v.speed_mps);
    highest_mps = std::max(std::min(highest_mps, limit_mps), v.speed_mps - emergency_mps);
    if (!has_leader) {
        const double target_mps = m.settings.leader_speed_share * limit_mps;
        const DriverSettings& driver = m.policies[static_cast<std::size_t>(v.policy)].driver;
        const double slowing_mps = v.speed_mps - driver.free_drive.deceleration_mps2 * m.step_s;
        const double free_mps = v.speed_mps > target_mps
                                    ? std::max(target_mps, slowing_mps)
                                    : std::min(v.speed_mps + share * (target_mps - v.speed_mps), target_mps);
        highest_mps = std::min(highest_mps, free_mps);
    }
    return std::min(highest_mps, speed_before_lower_limit_mps(m, lane, v));
}

// Returns the lower bound of the acceleration if the speed limit is above the calibrated limit; else 0.
inline double power_bound_mps2(const MesoModel& m, const Lane& lane, const Vehicle& v) {
    constexpr double kRounding = 1.001;
    const double calibrated_mps = kRounding * m.settings.speed_factor * m.settings.calibrated_speed_limit_mps;
    if (m.free_limit_mps(lane, v) <= calibrated_mps) return 0.0;
    return bin_value(m.power_bins_mps2, m.power_bins_per_mps, v.speed_mps);
}

inline bool has_platoon_leaders(const MesoModel& m) {
    return m.settings.leader_mps2 > 0.0 || !m.leader_bins_mps2.empty();
}

inline double contact_speed_mps(const MesoModel& m, const Leader& leader) {
    return std::max(leader.gap_m, 0.0) / m.step_s;
}

// Returns the next speed behind a leader in the intelligent driver model, without its term of free driving.
inline double idm_following_mps(const MesoModel& m, const Vehicle& v, const Leader& leader, std::int64_t tick) {
    const MesoPolicy& p = m.policies[static_cast<std::size_t>(v.policy)];
    HumanView view{leader.gap_m, v.speed_mps - leader.speed_mps};
    if (p.is_human) {
        const DriverRandom random{m.driver_key, v.id};
        HumanTimes times = human_times(p.driver.human, random);
        times.start_s += m.settings.start_delay_s;
        if (drives_off(times, v.start_steps * m.step_s, view.closing_mps, leader.gap_m - p.s0_m))
            return v.speed_mps + p.idm.acceleration_mps2 * m.step_s;
        view = estimated(p.driver.human, view, v.speed_mps, random, static_cast<double>(tick) * m.step_s);
    }
    const double standstill_m = p.s0_m + p.extra_gap_m(v.speed_mps);
    const double interaction = idm_interaction(p.idm, v.speed_mps, view, standstill_m, p.tau_s * v.speed_mps);
    return v.speed_mps + p.idm.acceleration_mps2 * m.step_s * (1.0 - interaction);
}

// Returns the desired next speed of a follower in a model of the Krauss family.
inline double krauss_desired_mps(const MesoModel& m, const Lane& lane, const Vehicle& v, const Leader& leader) {
    const MesoPolicy& p = m.policies[static_cast<std::size_t>(v.policy)];
    const KraussSettings& s = p.settings;
    const double law_extra_m = p.extra_gap_m(v.speed_mps);
    const double extra_m = law_extra_m + s.transient_gap_s2 * leader.acceleration_mps2;
    double safe_mps =
        meso_safe_speed_mps(p, leader.gap_m, leader.speed_mps + s.anticipation_s * leader.acceleration_mps2, extra_m);
    if (!p.constant_distance) {
        const double time_gap_mps = (leader.gap_m - p.s0_m - extra_m) / std::max(p.tau_s, 0.05);
        safe_mps -= s.gap_tracking * std::max(safe_mps - time_gap_mps, 0.0);
    }
    double acceleration_mps2 =
        s.acceleration_mps2 * std::min(1.0, s.constant_power_speed_mps / std::max(v.speed_mps, 1e-3));
    if (m.bounds_followers_by_power) acceleration_mps2 = std::max(acceleration_mps2, power_bound_mps2(m, lane, v));
    constexpr double kCatchUp_m = 2.0;
    const bool is_close = leader.gap_m - law_extra_m < p.equilibrium_gap_m(v.speed_mps) + kCatchUp_m;
    const double faster_mps = v.speed_mps + acceleration_mps2 * (is_close ? s.catch_up_factor : 1.0) * m.step_s;
    return std::min(safe_mps, faster_mps);
}

// Returns the next speed of a follower. Without platoon leaders, all vehicles are followers.
inline double next_follower_speed_mps(const MesoModel& m, const Lane& lane, const Vehicle& v, const Leader& leader,
                                      double highest_mps, std::int64_t tick) {
    const MesoPolicy& p = m.policies[static_cast<std::size_t>(v.policy)];
    const double lowest_mps = v.speed_mps - m.hardest_mps2 * m.step_s;
    const double contact_mps = contact_speed_mps(m, leader);
    const auto bounded = [&](double desired_mps) {
        return snapped(std::min({std::max(desired_mps, lowest_mps), contact_mps, highest_mps}));
    };
    if (p.is_idm) {
        const double free_term = idm_free_term(v.speed_mps, m.free_limit_mps(lane, v));
        return bounded(idm_following_mps(m, v, leader, tick) - p.idm.acceleration_mps2 * m.step_s * free_term);
    }
    const KraussSettings& s = p.settings;
    const double desired_mps = bounded(krauss_desired_mps(m, lane, v, leader));
    const double random = keyed_uniform(m.dawdling_key, v.id, static_cast<std::uint64_t>(tick));
    return desired_mps - s.dawdling * m.step_s * random * std::min(desired_mps, s.acceleration_mps2);
}

// Returns the next speed of a platoon leader, and sets is_platoon_leader to false if it becomes a follower.
inline double next_platoon_leader_speed_mps(const MesoModel& m, const Lane& lane, Vehicle& v, const Leader& leader,
                                            double highest_mps, std::int64_t tick) {
    const MesoPolicy& p = m.policies[static_cast<std::size_t>(v.policy)];
    double acceleration_mps2 = 0.0;
    if (!m.leader_bins_mps2.empty()) {
        const double first_mps2 = bin_value(m.leader_bins_mps2, m.leader_bins_per_mps, v.speed_mps);
        const double middle_mps = v.speed_mps + first_mps2 * 0.5 * m.step_s;
        acceleration_mps2 = bin_value(m.leader_bins_mps2, m.leader_bins_per_mps, middle_mps);
    } else {
        const double power_mps = m.settings.leader_constant_power_speed_mps;
        acceleration_mps2 = m.settings.leader_mps2 * power_mps / std::max(v.speed_mps, power_mps);
    }
    acceleration_mps2 = std::max(acceleration_mps2, power_bound_mps2(m, lane, v));
    const double free_mps = v.speed_mps + acceleration_mps2 * m.step_s;
    double following_mps = contact_speed_mps(m, leader);
    if (leader.id >= 0 && p.is_idm) {
        following_mps = std::min(following_mps, idm_following_mps(m, v, leader, tick));
    } else if (leader.id >= 0) {
        // Platoon leaders anticipate only if V2V relays the start of a queue. They keep no transient gap.
        const double anticipated_mps =
            m.settings.start_relay_vehicles > 0 ? p.settings.anticipation_s * leader.acceleration_mps2 : 0.0;
        following_mps = std::min(following_mps, meso_safe_speed_mps(p, leader.gap_m, leader.speed_mps + anticipated_mps,
                                                                    p.extra_gap_m(v.speed_mps)));
    }
    const double next_mps = snapped(std::min({following_mps, free_mps, highest_mps}));
    if (following_mps < free_mps && next_mps > 0.0) v.is_platoon_leader = false;
    return next_mps;
}

}  // namespace stopline::reference_engine
