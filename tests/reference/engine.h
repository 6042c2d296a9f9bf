// The reference engine: one run of a scenario.
#pragma once

#include <utility>

#include "reference/demand.h"
#include "reference/driver.h"
#include "reference/junction.h"
#include "reference/meso.h"
#include "reference/powertrain.h"
#include "reference/queue.h"
#include "reference/sensors.h"
#include "reference/world.h"
#include "scenario/make_network.h"

namespace stopline::reference_engine {

class Engine {
public:
    Engine(const Engine&) = delete;  // its parts refer to each other
    Engine& operator=(const Engine&) = delete;
    Engine(Engine&&) = delete;
    Engine& operator=(Engine&&) = delete;
    ~Engine() = default;

    // Prepares a run of the first population of the scenario.
    Engine(const Scenario& scenario, const Road& road, const UndocumentedRules& rules = {}, const Noise& noise = {})
        : scenario_(scenario),
          rules_(rules),
          noise_(noise),
          length_m_(stored(scenario.vehicle.length_m)),
          step_s_(scenario.is_meso() ? scenario.meso.step_s : scenario.step_s),
          draw_(scenario.populations.front(), scenario.seed),
          vehicle_(make_vehicle_model(scenario.vehicle)),
          junction_(scenario, policies_, length_m_) {
        make_policies();
        make_lanes(road);
        if (scenario.network.kind == "intersection") {
            signals_ = make_crossing_signals(scenario.signal, step_s_);
        } else {
            signals_ = {make_signal(scenario.signal, step_s_)};
        }
        const double start_delay_s = scenario.is_meso() ? scenario.meso.start_delay_s : 0.0;
        hesitation_ticks_ = ticks_in(scenario.driver.free_drive.hesitation_s + start_delay_s, step_s_);
        if (scenario.is_meso()) {
            make_meso();
        } else {
            driver_ = make_driver_model(scenario.driver, vehicle_);
            // The radar delay includes the step between the computation of a request and its effect. So the
            // controller uses data that are one step younger than the delay.
            radar_age_ = std::max(scenario.driver.cacc.radar_delay_s - step_s_, 0.0) / step_s_;
            v2v_age_ = scenario.driver.cacc.v2v_delay_s / step_s_;
        }
        if (scenario.demand.start == "queued") insert_queues();
    }

    const std::vector<Lane>& lanes() const { return lanes_; }
    const std::vector<LanePassage>& passages() const { return passages_; }
    const Situations& situations() const { return situations_; }
    std::int64_t tick() const { return tick_; }
    double time_s() const { return static_cast<double>(tick_) * step_s_; }

    void step() {
        std::vector<std::vector<Leader>> leaders;
        for (std::size_t lane = 0; lane < lanes_.size(); ++lane) leaders.push_back(find_leaders(lane));
        junction_.find_occupants(lanes_, signals_, tick_);
        for (Lane& lane : lanes_) {
            if (lane.signal < 0) continue;
            const bool is_open = decide_stop_line(scenario_, signal_of(lane), hesitation_ticks_, tick_, lane);
            if (is_open) junction_.hold_for_keep_clear(lanes_, signals_, tick_, lane);
        }
        junction_.decide(lanes_, leaders, tick_);
        situations_.held_at_green = junction_.holds();
        situations_.yielded = junction_.waits();
        situations_.deadlocks = junction_.resolved();
        scenario_.is_meso() ? move_meso(leaders) : move_full(leaders);
        for (std::size_t lane = 0; lane < lanes_.size(); ++lane) transfer(lane);
        for (std::size_t inlet = 0; inlet < entries_.size(); ++inlet) insert_next(inlet);
        ++tick_;
    }

private:
    void make_policies() {
        for (const auto& component : scenario_.populations.front().components) {
            const auto is_named = [&](const GapPolicySettings& policy) { return policy.name == component.policy; };
            policies_.push_back(
                make_gap_policy(*std::find_if(scenario_.policies.begin(), scenario_.policies.end(), is_named)));
        }
    }

    void make_lanes(const Road& road) {
        const LaneGraph graph = make_network(scenario_.network);
        entries_ = graph.entries;
        for (std::size_t number = 0; number < graph.lanes.size(); ++number) {
            const stopline::Lane& from = graph.lanes[number];
            Lane lane;
            lane.length_m = from.length_m;
            lane.limit_mps = from.limit_mps;
            lane.sine = from.gradient / std::sqrt(1.0 + from.gradient * from.gradient);
            lane.signal = from.signal_group;
            lane.origin = from.origin;
            if (!from.next.empty()) lane.next = from.next.front();
            if (lane.next < 0 && road.exit_limit_mps > 0.0) lane.limit_mps = road.exit_limit_mps;
            lane.conflicts = graph.conflicts_of(static_cast<int>(number));
            lanes_.push_back(lane);
        }
        for (Lane& lane : lanes_) {
            if (lane.next < 0) continue;
            const double next_mps = entry_speed_mps(lanes_[static_cast<std::size_t>(lane.next)]);
            if (next_mps < lane.limit_mps) lane.end_speed_mps = stored(next_mps);
        }
    }

    // Returns the highest speed at the start of a lane from which a vehicle can still brake to all lower limits ahead.
    double entry_speed_mps(const Lane& lane) const {
        if (lane.next < 0) return lane.limit_mps;
        const double end_mps = entry_speed_mps(lanes_[static_cast<std::size_t>(lane.next)]);
        const double braking_mps2 = scenario_.driver.free_drive.deceleration_mps2;
        return std::min(lane.limit_mps, std::sqrt(end_mps * end_mps + 2.0 * braking_mps2 * lane.length_m));
    }

    const Signal& signal_of(const Lane& lane) const { return signals_[static_cast<std::size_t>(lane.signal)]; }

    void make_meso() {
        meso_.settings = scenario_.meso;
        meso_.driver = scenario_.driver;
        meso_.step_s = step_s_;
        meso_.dawdling_key = dawdle_key(scenario_.seed);
        bool has_power_limit = false;
        for (const GapPolicy& policy : policies_) {
            meso_.policies.push_back(make_meso_policy(scenario_.meso, policy));
            has_power_limit |= meso_.policies.back().settings.constant_power_speed_mps < 100.0;
        }
        meso_.bounds_followers_by_power = has_power_limit || !rules_.power_bound_needs_power_limit;
        tabulate_profiles(vehicle_, meso_);
    }

    // Returns the last vehicle of the nearest occupied lane downstream; null if there is no such lane or if it begins
    // beyond the range of the radar. Sets `start_m` to the start of the occupied lane, measured from the start of
    // `lane`.
    const Vehicle* vehicle_beyond(const Lane& lane, double position_m, double& start_m) const {
        const Lane* here = &lane;
        start_m = 0.0;
        while (here->next >= 0) {
            start_m += here->length_m;
            if (start_m - position_m > scenario_.driver.cacc.radar_range_m) return nullptr;
            here = &lanes_[static_cast<std::size_t>(here->next)];
            if (!here->vehicles.empty()) return &here->vehicles.back();
        }
        return nullptr;
    }

    // Finds and returns the leader of each vehicle of a lane. If the leader of the first vehicle has changed, the first
    // vehicle counts as a platoon leader from now on, and its radar forgets the old leader.
    std::vector<Leader> find_leaders(std::size_t number) {
        Lane& lane = lanes_[number];
        std::vector<Leader> leaders;
        for (std::size_t k = 0; k < lane.vehicles.size(); ++k) {
            Vehicle& v = lane.vehicles[k];
            double start_m = 0.0;  // start of the leader's lane
            const Vehicle* const ahead = k > 0 ? &lane.vehicles[k - 1] : vehicle_beyond(lane, v.position_m, start_m);
            Leader leader;
            leader.speed_mps = v.speed_mps;
            leader.gap_m = kNoLeaderGap_m - length_m_ - v.position_m;
            if (ahead != nullptr) {
                leader = {ahead->id, start_m + ahead->position_m - length_m_ - v.position_m, ahead->speed_mps,
                          ahead->acceleration_mps2, ahead};
            }
            if (k == 0 && leader.id != v.leader_id) {
                v.is_platoon_leader = true;
                v.radar.assign(v.radar.size(), {leader.gap_m, v.speed_mps - leader.speed_mps});
            }
            v.leader_id = leader.id;
            leaders.push_back(leader);
        }
        return leaders;
    }

    // Returns the nearest position where a vehicle must stop in this step; empty if it need not stop.
    std::optional<double> stop_position_m(const Lane& lane, std::size_t k) const {
        const auto index = static_cast<std::ptrdiff_t>(k);
        std::optional<double> position_m;
        if (lane.stop_index == index) position_m = lane.length_m - scenario_.driver.stop.margin_m;
        for (const YieldPlace& place : lane.yield_stops) {
            if (place.index == index) position_m = std::min(position_m.value_or(place.position_m), place.position_m);
        }
        return position_m;
    }

    // Mesoscale mode: computes all speeds from the state at the start of the step, then moves all vehicles.
    void move_meso(const std::vector<std::vector<Leader>>& leaders) {
        for (Lane& lane : lanes_) {
            for (Vehicle& v : lane.vehicles) v.has_start_message = false;
            update_standing_queue(lane, tick_);
            relay_start_message(meso_, length_m_, lane);
        }
        std::vector<std::pair<Vehicle*, double>> next_speeds;
        for (std::size_t number = 0; number < lanes_.size(); ++number) {
            Lane& lane = lanes_[number];
            for (std::size_t k = 0; k < lane.vehicles.size(); ++k) {
                Vehicle& v = lane.vehicles[k];
                Leader leader = leaders[number][k];
                // A start message changes the acceleration of its receiver in this step. Only a follower on the same
                // lane uses the changed value.
                if (k > 0) leader.acceleration_mps2 = leader.vehicle->acceleration_mps2;
                leader.acceleration_mps2 = std::max(leader.acceleration_mps2, 0.0);
                const double highest_mps = highest_speed_mps(meso_, lane, v, stop_position_m(lane, k), leader.id >= 0);
                const bool leads = v.is_platoon_leader && has_platoon_leaders(meso_);
                const double next_mps = leads ? next_platoon_leader_speed_mps(meso_, lane, v, leader, highest_mps)
                                              : next_follower_speed_mps(meso_, lane, v, leader, highest_mps, tick_);
                situations_.became_follower += leads && !v.is_platoon_leader ? 1 : 0;
                situations_.start_messages += v.has_start_message ? 1 : 0;
                situations_.slowed_before_limit += next_mps == speed_before_lower_limit_mps(meso_, lane, v) ? 1 : 0;
                next_speeds.emplace_back(&v, next_mps);
            }
        }
        for (const auto& [v, next_mps] : next_speeds) {
            count_stops_and_starts(*v, next_mps);
            const double noisy_mps = next_mps > 0.0 ? next_mps + noise_.draw() : 0.0;
            v->acceleration_mps2 = stored((noisy_mps - v->speed_mps) / step_s_);
            v->speed_mps = noisy_mps;
            v->position_m += noisy_mps * step_s_;
        }
    }

    // Full dynamics: computes all views and requests from the state at the start of the step, then moves all vehicles.
    void move_full(const std::vector<std::vector<Leader>>& leaders) {
        std::vector<std::pair<Vehicle*, DriverRequest>> requests;
        std::vector<double> sines;
        for (std::size_t number = 0; number < lanes_.size(); ++number) {
            Lane& lane = lanes_[number];
            for (std::size_t k = 0; k < lane.vehicles.size(); ++k) {
                Vehicle& v = lane.vehicles[k];
                const Leader& leader = leaders[number][k];
                v.radar.push_front({leader.gap_m, v.speed_mps - leader.speed_mps});
                v.radar.pop_back();
                const View view = view_of(v, leader, radar_age_, v2v_age_);
                const bool was_leader = v.is_platoon_leader;
                const bool stops = static_cast<std::ptrdiff_t>(k) == lane.stop_index;
                const DriverRequest request = plan_request(driver_, policies_[static_cast<std::size_t>(v.policy)], lane,
                                                           view, stop_position_m(lane, k), step_s_, v);
                situations_.became_follower += was_leader && !v.is_platoon_leader && !stops ? 1 : 0;
                situations_.emergency_brakings += request.is_emergency ? 1 : 0;
                situations_.slowed_before_limit += request.is_slowing_down ? 1 : 0;
                requests.emplace_back(&v, request);
                sines.push_back(lane.sine);
            }
        }
        for (std::size_t k = 0; k < requests.size(); ++k)
            drive_vehicle(requests[k].second, sines[k], *requests[k].first);
    }

    void drive_vehicle(const DriverRequest& request, double sine, Vehicle& v) {
        const double lag_before_s = v.lag_s;
        const double acceleration_before_mps2 = v.acceleration_mps2;
        const int gear_before = v.gear;
        const double available = drive(vehicle_, request.mean_mps2, sine, step_s_, v);
        situations_.gear_changes += v.gear != gear_before ? 1 : 0;
        v.request_mps2 = request.request_mps2 + (request.request_mps2 != 0.0 ? noise_.draw() : 0.0);
        // The message announces the acceleration at the end of this step. The acceleration before is the mean over the
        // previous step, so it belongs to a time 1.5 steps earlier.
        const double announced_mps2 = std::min(request.request_mps2, available);
        const double share = std::min(1.5 * step_s_ / lag_before_s, 1.0);
        v.sent.push_front({acceleration_before_mps2 + (announced_mps2 - acceleration_before_mps2) * share,
                           announced_mps2, 1.0 / lag_before_s});
        v.sent.pop_back();
        if (v.speed_mps > 0.0) v.acceleration_mps2 += noise_.draw();
        const double before_mps = v.speed_mps;
        const double after_mps = before_mps + v.acceleration_mps2 * step_s_;
        const double next_mps = after_mps > kSpeedRounding_mps ? after_mps : 0.0;
        count_stops_and_starts(v, next_mps);
        v.speed_mps = next_mps;
        v.position_m += 0.5 * (before_mps + next_mps) * step_s_;
    }

    void count_stops_and_starts(const Vehicle& v, double next_mps) {
        const bool stops_at_red = std::any_of(lanes_.begin(), lanes_.end(), [&](const Lane& lane) {
            return lane.stopping_id == v.id && signal_of(lane).light(tick_) == Light::red;
        });
        situations_.stopped_at_red += stops_at_red && v.speed_mps > 0.0 && next_mps == 0.0 ? 1 : 0;
        situations_.started_in_queue += !v.is_platoon_leader && v.speed_mps == 0.0 && next_mps > 0.0 ? 1 : 0;
    }

    // Moves the vehicles that have reached the end of a lane to the next lane, or out of the network.
    void transfer(std::size_t number) {
        Lane& lane = lanes_[number];
        while (!lane.vehicles.empty() && lane.vehicles.front().position_m >= lane.length_m) {
            Vehicle v = lane.vehicles.front();
            lane.vehicles.pop_front();
            const double before_mps = scenario_.is_meso() ? v.speed_mps : v.speed_mps - v.acceleration_mps2 * step_s_;
            const double mean_mps = std::max(0.5 * (before_mps + v.speed_mps), 1e-6);
            const double since_s = std::clamp((v.position_m - lane.length_m) / mean_mps, 0.0, step_s_);
            const double time_s = static_cast<double>(tick_ + 1) * step_s_ - since_s;
            passages_.push_back({time_s, v.id, v.policy, static_cast<int>(number)});
            if (lane.next < 0) {
                ++situations_.exited;
                continue;
            }
            if (lane.signal >= 0) {
                v.entry_tick = tick_;
                situations_.passed_at_yellow += signal_of(lane).light(tick_) == Light::yellow ? 1 : 0;
                situations_.passed_at_red += signal_of(lane).light(tick_) == Light::red ? 1 : 0;
            }
            v.position_m -= lane.length_m;
            v.is_in_queue = false;
            lanes_[static_cast<std::size_t>(lane.next)].vehicles.push_back(std::move(v));
        }
    }

    double desired_gap_m(int policy, double speed_mps) const {
        const auto k = static_cast<std::size_t>(policy);
        if (!scenario_.is_meso()) return law_gap(policies_[k], speed_mps).gap_m;
        return meso_.policies[k].equilibrium_gap_m(speed_mps) + meso_.policies[k].extra_gap_m(speed_mps);
    }

    bool has_more_vehicles(const Lane& lane) const {
        return scenario_.demand.kind != "queue" || lane.entered < scenario_.demand.vehicles;
    }

    Lane& entry_lane(std::size_t inlet) { return lanes_[static_cast<std::size_t>(entries_[inlet])]; }

    void insert_next(std::size_t number) {
        Lane& lane = entry_lane(number);
        const auto inlet = static_cast<int>(number);
        const double now_s = static_cast<double>(tick_ + 1) * step_s_;
        if (!has_more_vehicles(lane) || now_s < next_entry_s(scenario_, lane, inlet)) return;
        const int policy = draw_.policy_of(inlet, lane.entered);
        const std::optional<EntryState> entry =
            entry_state(scenario_, lane, length_m_, [&](double speed_mps) { return desired_gap_m(policy, speed_mps); });
        if (entry) {
            insert(lane, policy, *entry);
            lane.last_entry_s = now_s;
        } else if (lane.blocked_number != lane.entered) {
            lane.blocked_number = lane.entered;
            ++situations_.entered_late;
        }
    }

    void insert_queues() {
        for (std::size_t number = 0; number < entries_.size(); ++number) {
            Lane& lane = entry_lane(number);
            double front_m = lane.length_m - scenario_.driver.stop.margin_m;
            while (front_m >= 0.0 && has_more_vehicles(lane)) {
                const auto inlet = static_cast<int>(number);
                insert(lane, draw_.policy_of(inlet, lane.entered), {front_m, 0.0});
                lane.last_entry_s = step_s_;
                front_m -= length_m_ + desired_gap_m(draw_.policy_of(inlet, lane.entered), 0.0);
            }
        }
    }

    // Inserts a vehicle behind the last one of a lane.
    void insert(Lane& lane, int policy, const EntryState& entry) {
        const Vehicle* ahead = lane.vehicles.empty() ? nullptr : &lane.vehicles.back();
        Vehicle v;
        v.id = next_id_++;
        v.policy = policy;
        v.position_m = entry.position_m;
        v.speed_mps = entry.speed_mps;
        v.gear = cruising_gear_of(vehicle_, v.speed_mps);
        v.gear_time_s = scenario_.vehicle.minimum_gear_time_s;
        v.lag_s = vehicle_.lag_unloaded_s.at(0.0);
        RadarSample radar{kNoLeaderGap_m, 0.0};
        if (ahead != nullptr) {
            v.leader_id = ahead->id;
            radar = {ahead->position_m - length_m_ - v.position_m, v.speed_mps - ahead->speed_mps};
            // A vehicle of a saturated inflow enters as a platoon member with the motion of its leader.
            if (scenario_.demand.kind == "saturated" && ahead->speed_mps <= v.speed_mps) copy_motion(*ahead, v);
        }
        v.radar.assign(static_cast<std::size_t>(radar_age_) + 3, radar);
        v.sent.assign(static_cast<std::size_t>(v2v_age_) + 3, {v.acceleration_mps2, v.request_mps2, 1.0 / v.lag_s});
        lane.vehicles.push_back(std::move(v));
        ++lane.entered;
        if (rules_.insertion_ends_start_messages) lane.disturbed_tick = tick_;
    }

    static void copy_motion(const Vehicle& from, Vehicle& to) {
        to.is_platoon_leader = false;
        to.acceleration_mps2 = from.acceleration_mps2;
        to.request_mps2 = from.request_mps2;
        to.torque_Nm = from.torque_Nm;
        to.brake_N = from.brake_N;
        to.gear_time_s = from.gear_time_s;
        to.lag_s = from.lag_s;
        to.gear = from.gear;
    }

    Scenario scenario_;
    UndocumentedRules rules_;
    Noise noise_;
    double length_m_;  // of every vehicle
    double step_s_;
    std::vector<Signal> signals_;
    PolicyDraw draw_;
    VehicleModel vehicle_;
    std::vector<GapPolicy> policies_;
    Junction junction_;
    MesoModel meso_;
    DriverModel driver_;
    double radar_age_ = 0.0;  // age of the radar data, in steps
    double v2v_age_ = 1.0;    // age of the V2V messages, in steps
    std::int64_t hesitation_ticks_ = 0;

    std::int64_t tick_ = 0;
    int next_id_ = 0;
    std::vector<int> entries_;  // lanes where vehicles enter
    std::vector<Lane> lanes_;
    std::vector<LanePassage> passages_;
    Situations situations_;
};

}  // namespace stopline::reference_engine
