// The reference engine: one run of a scenario. A step is a list of phases, in the order of core/README.md.
#pragma once

#include <string>
#include <utility>

#include "reference/insertion/trips.h"
#include "reference/junction/right_of_way.h"
#include "reference/junction/short_approaches.h"
#include "reference/junction/stop_lines.h"
#include "reference/lane_change/gap_search.h"
#include "reference/lane_change/lane_change.h"
#include "reference/platoons.h"
#include "reference/queue.h"
#include "reference/sensors.h"

namespace stopline::reference_engine {

class Engine {
public:
    Engine(const Engine&) = delete;  // its parts refer to each other
    Engine& operator=(const Engine&) = delete;
    Engine(Engine&&) = delete;
    Engine& operator=(Engine&&) = delete;
    ~Engine() = default;

    // Prepares a run of the first population of the scenario. `model`: compiled from the scenario.
    Engine(const Scenario& scenario, const Model& model, const UndocumentedRules& rules = {}, const Noise& noise = {})
        : noise_(noise),
          w_(scenario, model, rules),
          // The radar delay includes the step between the computation of a request and its effect. So the controller
          // uses data that are one step younger than the delay.
          radar_age_(std::max(w_.common_driver().cacc.radar_delay_s - w_.step_s, 0.0) / w_.step_s),
          v2v_age_(w_.common_driver().cacc.v2v_delay_s / w_.step_s),
          routes_(w_),
          entrance_(w_, w_.is_meso ? 0 : radar_rows(), w_.is_meso ? 0 : static_cast<std::size_t>(v2v_age_) + 3),
          inlets_(w_, routes_, entrance_),
          trips_(w_, routes_, entrance_),
          perception_(w_),
          stop_lines_(w_),
          right_of_way_(w_),
          short_approaches_(w_, routes_),
          gap_search_(w_, routes_),
          lane_changes_(w_, routes_),
          platoons_(w_) {
        if (model.demand.starts_queued) inlets_.insert_queues();
    }

    const std::vector<Lane>& lanes() const { return w_.lanes; }
    const std::vector<LanePassage>& passages() const { return w_.passages; }
    const Situations& situations() const { return w_.situations; }
    std::int64_t tick() const { return w_.tick; }
    double time_s() const { return w_.time_s(); }
    // Returns the first event that the engine does not cover: after it, the run is meaningless. Empty: none.
    const std::string& uncovered_event() const { return uncovered_event_; }

    void step() {
        w_.number_vehicles();
        right_of_way_.update_phases();
        find_leaders();
        OccupantSearch(w_).search();
        stop_lines_.decide();
        right_of_way_.decide();
        short_approaches_.add_stops();
        right_of_way_.resolve_deadlocks();
        gap_search_.search();
        w_.is_meso ? move_meso() : move_full();
        transfer();
        inlets_.insert_due();
        trips_.insert_due();
        lane_changes_.change_lanes();
        ++w_.tick;
        w_.update_lights();
    }

private:
    std::size_t radar_rows() const {
        double oldest_steps = radar_age_;
        for (const VehicleKind& kind : w_.kinds) {
            const HumanSettings& human = kind.settings().human;
            if (kind.is_human)
                oldest_steps = std::max(oldest_steps, (human.reaction_s + human.reaction_spread_s) / w_.step_s);
        }
        return static_cast<std::size_t>(oldest_steps) + 3;
    }

    // Finds the leader of each vehicle. If the leader of the first vehicle of a lane has changed, the vehicle counts as
    // a platoon leader from now on, and its radar forgets the old leader.
    void find_leaders() {
        for (Lane& lane : w_.lanes) {
            const std::vector<Leader>& leaders = w_.leaders[static_cast<std::size_t>(lane.number)] =
                perception_.leaders_on(lane);
            for (Vehicle& v : lane.vehicles) {
                const Leader& leader = leaders[v.index];
                const bool lost_leader = std::exchange(v.lost_leader, false) && !w_.rules.lost_leader_stays_on_radar;
                if (v.index == 0 && (leader.id != v.leader_id || lost_leader)) {
                    v.is_platoon_leader = true;
                    v.radar.assign(v.radar.size(), {leader.gap_m, v.speed_mps - leader.speed_mps, v.speed_mps});
                }
                v.leader_id = leader.id;
            }
        }
    }

    // Calls act(position) for each position where a vehicle must stop in this step.
    template <class Act>
    void for_each_stop(const Lane& lane, const Vehicle& v, Act act) const {
        if (lane.stop_index == static_cast<std::ptrdiff_t>(v.index)) act(lane.stop_line_m - w_.driver(v).stop.margin_m);
        for (const YieldStop& stop : lane.yield_stops) {
            if (stop.index == v.index) act(stop.position_m);
        }
    }

    // Mesoscale mode: returns the highest speed of the next step that limits, stops and gaps allow.
    double highest_meso_mps(const Lane& lane, const Vehicle& v, const Leader& leader) const {
        constexpr double kAligning_mps2 = 2.0;
        if (v.waits_to_start) return 0.0;
        double highest_mps = highest_speed_mps(w_.meso, lane, v, leader.id >= 0);
        for_each_stop(lane, v, [&](double position_m) {
            highest_mps = std::min(highest_mps, stopping_speed_mps(w_.meso, v, position_m));
        });
        for (const Alignment& alignment : lane.alignments) {
            if (alignment.index == v.index)
                highest_mps =
                    std::min(highest_mps, std::max(alignment.target_mps, v.speed_mps - kAligning_mps2 * w_.step_s));
        }
        return highest_mps;
    }

    // `platoon_mps`: the highest next speed of a leader of a mini-platoon.
    double next_meso_mps(const Lane& lane, Vehicle& v, const Leader& leader, double platoon_mps) {
        const double highest_mps = std::min(highest_meso_mps(lane, v, leader), platoon_mps);
        const bool leads = v.is_platoon_leader && has_platoon_leaders(w_.meso);
        double next_mps = leads ? next_platoon_leader_speed_mps(w_.meso, lane, v, leader, highest_mps, w_.tick)
                                : next_follower_speed_mps(w_.meso, lane, v, leader, highest_mps, w_.tick);
        const std::vector<double>& fastest = w_.meso.policies[static_cast<std::size_t>(v.policy)].fastest_mps2;
        if (!fastest.empty()) {
            const double bins_per_mps = static_cast<double>(fastest.size()) / kFastestTop_mps;
            next_mps = std::min(next_mps, v.speed_mps + bin_value(fastest, bins_per_mps, v.speed_mps) * w_.step_s);
        }
        w_.situations.became_follower += leads && !v.is_platoon_leader ? 1 : 0;
        w_.situations.start_messages += v.has_start_message ? 1 : 0;
        w_.situations.slowed_before_limit += next_mps == speed_before_lower_limit_mps(w_.meso, lane, v) ? 1 : 0;
        return next_mps;
    }

    // Mesoscale mode: finds the human drivers at rest whose leader has just started.
    void hold_waiting_drivers(Lane& lane) {
        for (Vehicle& v : lane.vehicles) {
            const VehicleKind& kind = w_.kind(v);
            if (!kind.is_human) continue;
            HumanTimes times = human_times(kind.settings().human, DriverRandom{driver_key(w_.scenario.seed), v.id});
            times.start_s += w_.meso.settings.start_delay_s;
            const Leader& leader = w_.leader_of(v);
            update_start(times, leader.gap_m - kind.standstill_gap_m, leader.speed_mps, w_.step_s, v);
            if (v.waits_to_start) lane.disturbed_tick = w_.tick;
        }
    }

    // Mesoscale mode: computes all speeds from the state at the start of the step, then moves all vehicles.
    void move_meso() {
        for (Lane& lane : w_.lanes) {
            for (Vehicle& v : lane.vehicles) v.has_start_message = false;
            hold_waiting_drivers(lane);
            update_standing_queue(lane, w_.tick);
            relay_start_message(w_.meso, lane);
        }
        platoons_.update();
        std::vector<std::pair<Vehicle*, double>> next_speeds;
        for (Lane& lane : w_.lanes) {
            for (Vehicle& v : lane.vehicles) {
                Leader leader = w_.leader_of(v);
                // A start message changes the acceleration of its receiver in this step. Only a follower on the same
                // lane uses the changed value.
                if (v.index > 0) leader.acceleration_mps2 = leader.vehicle->acceleration_mps2;
                const double platoon_mps = platoons_.highest_mps(leader, v);
                leader.acceleration_mps2 = std::max(leader.acceleration_mps2, 0.0);
                next_speeds.emplace_back(&v, next_meso_mps(lane, v, leader, platoon_mps));
            }
        }
        for (const auto& [v, next_mps] : next_speeds) {
            count_stops_and_starts(*v, next_mps);
            const double noisy_mps = next_mps > 0.0 ? next_mps + noise_.draw() : 0.0;
            v->acceleration_mps2 = stored((noisy_mps - v->speed_mps) / w_.step_s);
            v->speed_mps = noisy_mps;
            advance(*v, noisy_mps * w_.step_s);
        }
    }

    // Full dynamics: returns the conditions that the driver obeys besides its leader.
    RoadView road_view(const Lane& lane, const Vehicle& v, double hidden_leader_mps2) {
        constexpr double kTimeToTarget_s = 1.0;
        constexpr double kAligning_mps2 = 2.0;
        const DriverModel& driver = w_.kind(v).driver;
        RoadView road{std::min(lane.limit_mps, w_.maximum_speed_mps(v.policy)), lane.next_limit_m - v.position_m,
                      hidden_leader_mps2};
        w_.situations.hidden_leaders += hidden_leader_mps2 < kNoLimit ? 1 : 0;
        const auto add = [&](double demand_mps2) { road.demand_mps2 = std::min(road.demand_mps2, demand_mps2); };
        for_each_stop(lane, v, [&](double position_m) {
            add(stop_at_line_mps2(driver, v.speed_mps, position_m - v.position_m));
        });
        for (const Alignment& alignment : lane.alignments) {
            if (alignment.index == v.index)
                add(std::max((alignment.target_mps - v.speed_mps) / kTimeToTarget_s, -kAligning_mps2));
        }
        if (w_.model.has_speed_limiters)
            add(driver.settings.free_drive.speed_gain_1ps * (w_.maximum_speed_mps(v.policy) - v.speed_mps));
        return road;
    }

    // Returns the desired gap of a human driver minus the standstill gap.
    double human_growth_m(const VehicleKind& kind, const Vehicle& v) const {
        const double next_mps = std::max(v.speed_mps + v.acceleration_mps2 * w_.step_s, 0.0);
        return std::max(law_gap(kind.policy, next_mps).gap_m - kind.standstill_gap_m, 0.0);
    }

    // Returns the reaction of a human driver to the vehicles ahead on its lane and to the leader of the first of them:
    // the sum of the terms (s* / s)^2 of the intelligent driver model.
    double human_interaction(const VehicleKind& kind, const HumanTimes& times, const View& view, const Lane& lane,
                             const Vehicle& v) const {
        const HumanSettings& human = kind.settings().human;
        const double standstill_m = kind.standstill_gap_m;
        if (drives_off(times, v.start_steps * w_.step_s, view.closing_mps, view.gap_m - standstill_m)) return 0.0;
        const double age_s = std::clamp(v.start_steps * w_.step_s - times.start_s, 0.0, times.reaction_s);
        const auto age = static_cast<std::size_t>(std::max<std::int64_t>(ticks_in(age_s, w_.step_s) - 1, 0));
        const double own_before_mps = v.radar[age].own_mps;
        const double driven_m = 0.5 * (own_before_mps + v.speed_mps) * age_s;
        const std::size_t most = v.start_steps == 0 ? 1 : static_cast<std::size_t>(human.anticipated_vehicles);
        std::vector<HumanView> views;
        double gaps_m = 0.0;      // from the driver to the n-th vehicle, without the vehicles between
        double slower_mps = 0.0;  // own speed minus the speed of the n-th vehicle
        for (std::size_t n = 1; n <= std::min(most, v.index + 1); ++n) {
            const RadarSample& sample = lane.vehicles[v.index + 1 - n].radar[age];
            gaps_m += sample.gap_m;
            slower_mps += sample.closing_mps;
            const double other_mps = own_before_mps - slower_mps;
            const double gap_m = gaps_m + other_mps * age_s - driven_m;
            if (gap_m > kind.settings().cacc.radar_range_m) break;
            const double shortest_m = views.empty() ? gap_m : static_cast<double>(n) * views[0].gap_m;
            views.push_back({std::max(gap_m, shortest_m), v.speed_mps - other_mps});
        }
        double squares = 0.0;
        for (std::size_t n = 1; n <= views.size(); ++n) squares += 1.0 / static_cast<double>(n * n);
        const double factor = 1.0 / std::sqrt(squares);
        const double growth_m = human_growth_m(kind, v);
        const DriverRandom random{driver_key(w_.scenario.seed), v.id};
        double sum = 0.0;
        for (const HumanView& exact : views) {
            const HumanView seen = estimated(human, exact, v.speed_mps, random, w_.time_s());
            sum += idm_interaction(human.idm, v.speed_mps, seen, factor * standstill_m, factor * growth_m);
        }
        return sum;
    }

    DriverRequest request_of(const Lane& lane, const Vehicle& v, const RoadView& road, const Leader& leader,
                             Vehicle& changed) {
        const VehicleKind& kind = w_.kind(v);
        const View view = view_of(v, leader, radar_age_, v2v_age_);
        if (!kind.is_human) return plan_request(kind.driver, kind.policy, road, view, w_.step_s, changed);
        w_.situations.human_steps += v.speed_mps > 0.0 ? 1 : 0;
        const HumanTimes times = human_times(kind.settings().human, DriverRandom{driver_key(w_.scenario.seed), v.id});
        update_start(times, view.gap_m - kind.standstill_gap_m, leader.speed_mps, w_.step_s, changed);
        const double interaction = human_interaction(kind, times, view, lane, v);
        View exact = view;
        exact.acceleration_mps2 = exact.request_mps2 = leader.acceleration_mps2;
        exact.gap_m -=
            std::max(kind.vehicle.settings.brake_lag_s - 0.2, 0.0) * v.speed_mps;  // brakes that respond later
        return plan_human_request(kind.driver, road, exact, interaction, w_.step_s, changed);
    }

    // Full dynamics: computes all requests from the state at the start of the step, then moves all vehicles.
    void move_full() {
        std::vector<std::pair<Vehicle*, DriverRequest>> requests;
        for (Lane& lane : w_.lanes) {
            const std::vector<double> hidden_mps2 = perception_.hidden_leader_demands(lane);
            for (Vehicle& v : lane.vehicles) {
                const Leader& leader = w_.leader_of(v);
                v.radar.push_front({leader.gap_m, v.speed_mps - leader.speed_mps, v.speed_mps});
                v.radar.pop_back();
                const bool was_leader = v.is_platoon_leader;
                const bool stops = static_cast<std::ptrdiff_t>(v.index) == lane.stop_index;
                const DriverRequest request = request_of(lane, v, road_view(lane, v, hidden_mps2[v.index]), leader, v);
                w_.situations.became_follower += was_leader && !v.is_platoon_leader && !stops ? 1 : 0;
                w_.situations.emergency_brakings += request.is_emergency ? 1 : 0;
                w_.situations.slowed_before_limit += request.is_slowing_down ? 1 : 0;
                requests.emplace_back(&v, request);
            }
        }
        for (const auto& [v, request] : requests) drive_vehicle(request, *v);
    }

    void drive_vehicle(const DriverRequest& request, Vehicle& v) {
        const double lag_before_s = v.lag_s;
        const double acceleration_before_mps2 = v.acceleration_mps2;
        const int gear_before = v.gear;
        const double available = drive(w_.kind(v).vehicle, request.mean_mps2, w_.lane_of(v).sine, w_.step_s, v);
        w_.situations.gear_changes += v.gear != gear_before ? 1 : 0;
        v.request_mps2 = request.request_mps2 + (request.request_mps2 != 0.0 ? noise_.draw() : 0.0);
        // The message announces the acceleration at the end of this step. The acceleration before is the mean over the
        // previous step, so it belongs to a time 1.5 steps earlier.
        const double announced_mps2 = std::min(request.request_mps2, available);
        const double share = std::min(1.5 * w_.step_s / lag_before_s, 1.0);
        v.sent.push_front({acceleration_before_mps2 + (announced_mps2 - acceleration_before_mps2) * share,
                           announced_mps2, 1.0 / lag_before_s});
        v.sent.pop_back();
        if (v.speed_mps > 0.0) v.acceleration_mps2 += noise_.draw();
        const double before_mps = v.speed_mps;
        const double after_mps = before_mps + v.acceleration_mps2 * w_.step_s;
        const double next_mps = after_mps > kSpeedRounding_mps ? after_mps : 0.0;
        count_stops_and_starts(v, next_mps);
        v.speed_mps = next_mps;
        advance(v, 0.5 * (before_mps + next_mps) * w_.step_s);
    }

    void advance(Vehicle& v, double distance_m) {
        const Lane& lane = w_.lane_of(v);
        const bool was_before_line = v.position_m < lane.stop_line_m;
        v.position_m += distance_m;
        if (was_before_line) enter_beyond_line(lane, v);
    }

    // Lets a vehicle enter the intersection if it has passed the stop line of the lane.
    void enter_beyond_line(const Lane& lane, Vehicle& v) {
        if (lane.signal_group < 0 || v.position_m < lane.stop_line_m) return;
        v.entry_tick = w_.tick;
        v.line_stop_tick = -1;
        const Light light = w_.light(w_.group_of(lane, v.next_lane));
        w_.situations.passed_at_yellow += light == Light::yellow ? 1 : 0;
        w_.situations.passed_at_red += light == Light::red ? 1 : 0;
    }

    void count_stops_and_starts(const Vehicle& v, double next_mps) {
        const Lane& lane = w_.lane_of(v);
        const bool stops_at_red = lane.signal_group >= 0 && lane.stopping_id == v.id &&
                                  w_.light(w_.group_of(lane, v.next_lane)) == Light::red;
        w_.situations.stopped_at_red += stops_at_red && v.speed_mps > 0.0 && next_mps == 0.0 ? 1 : 0;
        w_.situations.started_in_queue += !v.is_platoon_leader && v.speed_mps == 0.0 && next_mps > 0.0 ? 1 : 0;
    }

    static bool is_on_last_edge(const World& world, const Vehicle& v) {
        return v.next_lane < 0 && v.trip >= 0 && world.route_of(v.route).size() == 1;
    }

    // Returns true if the front of a vehicle has passed the end of its lane, or the stop line where its trip ends.
    bool has_left(const Lane& lane, const Vehicle& v) const {
        return v.position_m >= lane.length_m ||
               (lane.signal_group >= 0 && v.position_m >= lane.stop_line_m && is_on_last_edge(w_, v));
    }

    // Moves the vehicles that have reached the end of a lane to the next lane, or out of the network. A vehicle can
    // drive over several short lanes in one step. Each round moves the vehicles by one lane.
    void transfer() {
        std::vector<std::size_t> left_lanes;
        for (const std::size_t number : w_.order) {
            const Lane& lane = w_.lanes[number];
            if (!lane.vehicles.empty() && has_left(lane, lane.vehicles.front())) left_lanes.push_back(number);
        }
        while (!left_lanes.empty()) left_lanes = transfer_from(left_lanes);
    }

    // Moves the vehicles that have left these lanes by one lane. Returns the lanes that they have reached and left
    // again.
    std::vector<std::size_t> transfer_from(const std::vector<std::size_t>& left_lanes) {
        std::vector<std::size_t> left_again;
        for (const std::size_t number : left_lanes) {
            Lane& lane = w_.lanes[number];
            while (!lane.vehicles.empty() && has_left(lane, lane.vehicles.front())) {
                Vehicle v = std::move(lane.vehicles.front());
                lane.vehicles.pop_front();
                const int next = v.next_lane;
                transfer(lane, std::move(v));
                if (next >= 0 && has_left(w_.lane(next), w_.lane(next).vehicles.back()))
                    left_again.push_back(static_cast<std::size_t>(next));
            }
        }
        return left_again;
    }

    void transfer(Lane& lane, Vehicle v) {
        if (v.next_lane < 0 && v.trip >= 0 && !is_on_last_edge(w_, v)) uncovered_event_ = "a missed turn";
        const double before_mps = w_.is_meso ? v.speed_mps : v.speed_mps - v.acceleration_mps2 * w_.step_s;
        const double mean_mps = std::max(0.5 * (before_mps + v.speed_mps), 1e-6);
        const double end_m = v.next_lane < 0 && v.trip >= 0 ? lane.stop_line_m : lane.length_m;
        const double since_s = std::clamp((v.position_m - end_m) / mean_mps, 0.0, w_.step_s);
        const double time_s = static_cast<double>(w_.tick + 1) * w_.step_s - since_s;
        w_.passages.push_back({time_s, v.id, v.policy, lane.number});
        if (v.next_lane < 0) {
            ++w_.situations.exited;
            return;
        }
        Lane& next = w_.lane(v.next_lane);
        v.position_m -= lane.length_m;
        v.is_in_queue = false;
        v.second_previous_lane = std::exchange(v.previous_lane, lane.number);
        routes_.set_route_index(v, v.route_index + 1);
        routes_.choose_next_route(next.number, v);
        enter_beyond_line(next, v);
        next.vehicles.push_back(std::move(v));
    }

    Noise noise_;
    World w_;
    double radar_age_;  // age of the radar data, in steps
    double v2v_age_;    // age of the V2V messages, in steps
    Routes routes_;
    Entrance entrance_;
    InletInsertion inlets_;
    TripInsertion trips_;
    Perception perception_;
    StopLines stop_lines_;
    RightOfWay right_of_way_;
    ShortApproaches short_approaches_;
    GapSearch gap_search_;
    LaneChanges lane_changes_;
    Platoons platoons_;
    std::string uncovered_event_;
};

}  // namespace stopline::reference_engine
