// Platoons of limited length in the mesoscale mode of the reference engine.
#pragma once

#include "reference/meso.h"
#include "reference/world.h"

namespace stopline::reference_engine {

class Platoons {
public:
    explicit Platoons(World& world) : w_(world), longest_(world.is_meso ? world.model.v2v_plan.max_platoon : 0) {}

    // Once a second, decides from front to rear of each lane which vehicles lead mini-platoons. The first vehicle of a
    // lane sees its leader on another lane as it was before.
    void update() {
        if (longest_ == 0 || w_.tick % std::max<std::int64_t>(std::llround(1.0 / w_.step_s), 1) != 0) return;
        std::vector<int> places_ahead;
        for (const Lane& lane : w_.lanes) {
            const Vehicle* ahead = lane.vehicles.empty() ? nullptr : w_.leader_of(lane.vehicles.front()).vehicle;
            places_ahead.push_back(ahead == nullptr ? kNone : ahead->platoon_place);
        }
        for (Lane& lane : w_.lanes) {
            int place_ahead = places_ahead[static_cast<std::size_t>(&lane - w_.lanes.data())];
            for (Vehicle& v : lane.vehicles) {
                update(place_ahead, v);
                place_ahead = v.platoon_place;
            }
        }
    }

    // Moves the time gap of a leader of a mini-platoon. Returns the highest next speed with which it keeps the gap.
    double highest_mps(const Leader& leader, Vehicle& v) const {
        if (longest_ == 0 || v.is_slow() || (!v.leads_mini_platoon && v.platoon_time_gap_s == 0.0)) return kNoLimit;
        move_time_gap(v);
        if (v.platoon_time_gap_s <= 0.0 || leader.id < 0) return kNoLimit;
        ++w_.situations.time_gap_steps;
        const CaccSettings& cacc = w_.driver(v).cacc;
        const MesoPolicy& policy = w_.meso.policies[static_cast<std::size_t>(v.policy)];
        const double dt = w_.step_s;
        const double time_gap_s = v.platoon_time_gap_s;
        const double lambda = cacc.feedback_kp_1ps2 / cacc.feedback_kd_1ps;
        const double ahead_mps = std::max(leader.speed_mps + leader.acceleration_mps2 * dt, 0.0);
        const double excess_m = leader.gap_m - policy.equilibrium_gap_m(0.0);
        // The law T dv/dt = v_l - v - (dT/dt) v + lambda (excess - T v), with v at the end of the step.
        const double law_mps = (time_gap_s * v.speed_mps + dt * ahead_mps + dt * lambda * excess_m) /
                               (time_gap_s + dt + dt * v.platoon_time_gap_rate + dt * lambda * time_gap_s);
        return std::max(law_mps, v.speed_mps - cacc.deceleration_comfort_mps2 * dt);
    }

private:
    static constexpr int kNone = -1;

    void update(int place_ahead, Vehicle& v) const {
        const MesoPolicy& policy = w_.meso.policies[static_cast<std::size_t>(v.policy)];
        if (!policy.constant_distance) return;
        const Leader& leader = w_.leader_of(v);
        const bool led_before = v.leads_mini_platoon && v.platoon_leader_id == leader.id;
        const double desired_m = policy.equilibrium_gap_m(v.speed_mps) + policy.extra_gap_m(v.speed_mps);
        const double longest_excess_m = v.platoon_place > 0 || led_before ? 25.0 : 15.0;
        const bool follows = leader.id >= 0 && place_ahead != kNone &&
                             !(v.is_platoon_leader && has_platoon_leaders(w_.meso)) &&
                             leader.gap_m - desired_m < longest_excess_m;
        const bool joins = follows && place_ahead + 1 < longest_ && (!led_before || v.speed_mps == 0.0);
        v.platoon_place = joins ? place_ahead + 1 : 0;
        v.leads_mini_platoon = follows && !joins;
        v.platoon_leader_id = leader.id;
        if (v.is_slow()) v.platoon_time_gap_s = v.platoon_time_gap_rate = 0.0;
    }

    // The gap opens by at most 1.5 m/s and closes by at most 1 m/s. Its rate changes by at most 1 m/s2.
    void move_time_gap(Vehicle& v) const {
        constexpr double kSlow_mps = 5.0;
        const double speed_mps = std::max(v.speed_mps, kSlow_mps);
        const double target_s = v.leads_mini_platoon ? w_.model.v2v_plan.platoon_time_gap_s : 0.0;
        const double wanted = std::clamp(target_s - v.platoon_time_gap_s, -1.0 / speed_mps, 1.5 / speed_mps);
        const double most = w_.step_s / speed_mps;
        v.platoon_time_gap_rate += std::clamp(wanted - v.platoon_time_gap_rate, -most, most);
        v.platoon_time_gap_s += v.platoon_time_gap_rate * w_.step_s;
        if (target_s == 0.0 && v.platoon_time_gap_s < 1e-4) v.platoon_time_gap_s = v.platoon_time_gap_rate = 0.0;
    }

    World& w_;
    int longest_;  // largest number of vehicles of a platoon; 0: no limit
};

}  // namespace stopline::reference_engine
