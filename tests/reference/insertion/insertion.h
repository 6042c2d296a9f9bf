// Vehicles that enter the network in the reference engine: at inlets, and as queues before the first step. The rules
// are those of the comments in core/sim/insertion/insert_vehicles.cpp.
#pragma once

#include <optional>

#include "reference/demand.h"
#include "reference/perception.h"

namespace stopline::reference_engine {

// Creates vehicles.
class Entrance {
public:
    Entrance(World& world, std::size_t radar_rows, std::size_t v2v_rows)
        : w_(world), radar_rows_(radar_rows), v2v_rows_(v2v_rows) {}

    // Returns a new vehicle in steady driving that is not on its lane yet.
    Vehicle create(int policy, double length_m, double position_m, double speed_mps) {
        const VehicleModel& model = w_.kind(policy).vehicle;
        Vehicle v;
        v.id = next_id_++;
        v.policy = policy;
        v.length_m = stored(length_m);
        v.position_m = position_m;
        v.speed_mps = speed_mps;
        v.gear = cruising_gear_of(model, speed_mps);
        v.gear_time_s = model.settings.minimum_gear_time_s;
        v.lag_s = model.lag_unloaded_s.at(0.0);
        return v;
    }

    // Inserts a vehicle at a place of a lane, and initialises its sensors.
    void insert(Lane& lane, std::size_t index, Vehicle v) const {
        RadarSample radar{kNoLeaderGap_m, 0.0, v.speed_mps};
        if (index > 0) {
            const Vehicle& ahead = lane.vehicles[index - 1];
            v.leader_id = ahead.id;
            radar = {ahead.rear_m() - v.position_m, v.speed_mps - ahead.speed_mps, v.speed_mps};
        }
        v.radar.assign(radar_rows_, radar);
        v.sent.assign(v2v_rows_, {v.acceleration_mps2, v.request_mps2, 1.0 / v.lag_s});
        lane.vehicles.insert(lane.vehicles.begin() + static_cast<std::ptrdiff_t>(index), std::move(v));
        if (w_.rules.insertion_ends_start_messages) lane.disturbed_tick = w_.tick;
    }

private:
    World& w_;
    std::size_t radar_rows_;
    std::size_t v2v_rows_;
    int next_id_ = 0;
};

class InletInsertion {
public:
    InletInsertion(World& world, Routes& routes, Entrance& entrance)
        : w_(world), routes_(routes), entrance_(entrance), perception_(world) {}

    // Inserts a queue on the lane of each inlet, from the stop line to the start of the lane.
    void insert_queues() {
        for (std::size_t number = 0; number < routes_.inlets.size(); ++number) {
            if (plan(number).vehicles == 0) continue;
            Inlet& inlet = routes_.inlets[number];
            Lane& lane = w_.lane(plan(number).lane);
            draw_next(number);
            double front_m = lane.stop_line_m - w_.kind(inlet.next_policy).settings().stop.margin_m;
            while (front_m >= 0.0 && inlet.entered < plan(number).vehicles) {
                insert(number, {front_m, 0.0});
                draw_next(number);
                front_m -= lane.vehicles.back().length_m + w_.desired_gap_m(inlet.next_policy, 0.0);
            }
        }
    }

    // Inserts the next vehicle of each inlet if it is due and has room.
    void insert_due() {
        w_.number_vehicles();
        for (std::size_t number = 0; number < routes_.inlets.size(); ++number) {
            Inlet& inlet = routes_.inlets[number];
            if (inlet.entered >= plan(number).vehicles) continue;
            draw_next(number);
            const double now_s = static_cast<double>(w_.tick + 1) * w_.step_s;
            if (now_s < next_entry_s(number)) continue;
            if (const std::optional<Entry> entry = entry_of(number, inlet.next_policy)) {
                insert(number, *entry);
            } else if (std::exchange(inlet.blocked_number, inlet.entered) != inlet.entered) {
                ++w_.situations.entered_late;
            }
        }
    }

private:
    struct Entry {
        double position_m = 0.0;
        double speed_mps = 0.0;
    };

    const DemandPlan::Inlet& plan(std::size_t number) const { return w_.model.demand.inlets[number]; }

    void draw_next(std::size_t number) {
        Inlet& inlet = routes_.inlets[number];
        if (inlet.next_policy >= 0) return;
        inlet.next_policy = routes_.policy_of(static_cast<int>(number), inlet.entered);
        inlet.next_route = routes_.draw_route(static_cast<int>(number), inlet.entered, false);
    }

    double next_entry_s(std::size_t number) const {
        const DemandPlan& demand = w_.model.demand;
        const Inlet& inlet = routes_.inlets[number];
        const double own_headway_s = plan(number).headway_s;
        if (demand.saturated && own_headway_s == 0.0) return -1e9;
        const double headway_s = own_headway_s > 0.0 ? own_headway_s : demand.entry_headway_s;
        if (!demand.evenly_spaced && own_headway_s == 0.0) return inlet.last_entry_s + headway_s;
        const double offset =
            random_uniform(w_.scenario.seed, static_cast<std::uint64_t>(number), 0, Purpose::insertion);
        return (static_cast<double>(inlet.entered) + offset) * headway_s;
    }

    // Returns the highest speed from which a vehicle can stop comfortably before the line.
    double stoppable_mps(const Lane& lane, int policy, double front_m) const {
        if (lane.signal_group < 0 || front_m > lane.stop_line_m) return kNoLimit;
        const StopSettings& stop = w_.kind(policy).settings().stop;
        return std::sqrt(2.0 * stop.deceleration_mps2 * std::max(lane.stop_line_m - stop.margin_m - front_m, 0.0));
    }

    // Returns the state in which the next vehicle enters; empty if it finds no room. On a link lane between two
    // intersections, the whole vehicle must be on the lane.
    std::optional<Entry> entry_of(std::size_t number, int policy) const {
        const Lane& lane = w_.lane(plan(number).lane);
        const DemandPlan& demand = w_.model.demand;
        const std::span<const int> connections = w_.connections_to(lane.number);
        const bool is_link = !connections.empty();
        if (std::any_of(connections.begin(), connections.end(),
                        [&](int connection) { return !w_.lane(connection).vehicles.empty(); }))
            return std::nullopt;
        const PowertrainSettings& vehicle = w_.kind(policy).vehicle.settings;
        const double front_m = is_link ? vehicle.length_m : 0.0;
        double highest_mps = std::min({demand.entry_speed_mps, lane.limit_mps, vehicle.maximum_speed_mps});
        if (is_link) highest_mps = std::min(highest_mps, stoppable_mps(lane, policy, front_m));
        if (lane.vehicles.empty()) return entry_on_empty_lane(number, policy, front_m, highest_mps);
        const Vehicle& last = lane.vehicles.back();
        const double speed_mps = std::min(highest_mps, last.speed_mps);
        const double desired_m = w_.desired_gap_m(policy, speed_mps);
        // Vehicles of a saturated inflow enter as a platoon, with the desired gap.
        if (demand.saturated && plan(number).headway_s == 0.0) {
            const double position_m = last.rear_m() - desired_m;
            if (position_m < front_m) return std::nullopt;
            return Entry{position_m, speed_mps};
        }
        const double gap_m = last.rear_m() - front_m;
        if (!demand.evenly_spaced && plan(number).headway_s == 0.0) {
            if (gap_m < desired_m + 0.5 * demand.entry_headway_s * speed_mps) return std::nullopt;
            return Entry{front_m, speed_mps};
        }
        if (gap_m < desired_m) return std::nullopt;
        return Entry{front_m, safe_mps(policy, gap_m, last.speed_mps, highest_mps)};
    }

    // Returns the highest speed, at most `wanted_mps`, from which a vehicle can brake comfortably to the speed of its
    // leader and then has its desired gap. The leader's speed itself is safe.
    double safe_mps(int policy, double gap_m, double leader_mps, double wanted_mps) const {
        const auto is_safe = [&](double speed_mps) {
            const double b = w_.kind(policy).settings().stop.deceleration_mps2;
            const double braking_m = std::max(speed_mps * speed_mps - leader_mps * leader_mps, 0.0) / (2.0 * b);
            return gap_m >= w_.desired_gap_m(policy, speed_mps) + braking_m;
        };
        if (is_safe(wanted_mps)) return wanted_mps;
        double low_mps = std::min(leader_mps, wanted_mps);
        double high_mps = wanted_mps;
        for (int k = 0; k < 12; ++k) {
            const double middle_mps = (low_mps + high_mps) / 2.0;
            (is_safe(middle_mps) ? low_mps : high_mps) = middle_mps;
        }
        return low_mps;
    }

    // The rear of a vehicle whose front has left the lane can still be on the lane.
    std::optional<Entry> entry_on_empty_lane(std::size_t number, int policy, double front_m, double highest_mps) const {
        const Lane& lane = w_.lane(plan(number).lane);
        int route = routes_.inlets[number].next_route;
        if (w_.route_of(route).front() != lane.number)
            route = routes_.option(lane.number, routes_.turn_of(route)).route;
        const Ahead leader =
            perception_.beyond(lane.number, front_m, {route, 0}, w_.common_driver().cacc.radar_range_m);
        if (leader.vehicle == nullptr) return Entry{front_m, highest_mps};
        const double gap_m = leader.rear_m() - front_m;
        const double leader_mps = leader.vehicle->speed_mps;
        if (gap_m < w_.desired_gap_m(policy, std::min(highest_mps, leader_mps))) return std::nullopt;
        return Entry{front_m, safe_mps(policy, gap_m, leader_mps, highest_mps)};
    }

    void insert(std::size_t number, const Entry& entry) {
        Inlet& inlet = routes_.inlets[number];
        Lane& lane = w_.lane(plan(number).lane);
        const double length_m = w_.kind(inlet.next_policy).length_m;
        Vehicle v = entrance_.create(inlet.next_policy, length_m, entry.position_m, entry.speed_mps);
        v.route = inlet.next_route;
        inlet.next_policy = -1;
        if (w_.model.demand.saturated && !lane.vehicles.empty() && lane.vehicles.back().speed_mps <= v.speed_mps)
            join_platoon(lane.vehicles.back(), v);
        routes_.adopt_lane_route(lane.number, v);
        routes_.draw_later_turns(lane.number, v, true);
        entrance_.insert(lane, lane.vehicles.size(), std::move(v));
        ++inlet.entered;
        inlet.last_entry_s = static_cast<double>(w_.tick + 1) * w_.step_s;
    }

    // A vehicle of a saturated inflow enters as a platoon member with the motion of its leader. Torque and gear of
    // another vehicle type do not fit, so only its braking is taken over.
    void join_platoon(const Vehicle& leader, Vehicle& v) const {
        v.is_platoon_leader = false;
        v.acceleration_mps2 = leader.acceleration_mps2;
        if (w_.is_meso) return;
        const auto type = [&](const Vehicle& of) {
            return w_.model.classes[static_cast<std::size_t>(of.policy)].vehicle;
        };
        v.request_mps2 = leader.request_mps2;
        v.brake_N = leader.brake_N;
        if (type(v) != type(leader)) {
            v.acceleration_mps2 = std::min(leader.acceleration_mps2, 0.0);
            v.request_mps2 = std::min(leader.request_mps2, 0.0);
            v.brake_N *= w_.kind(v).vehicle.mass_kg / w_.kind(leader).vehicle.mass_kg;
            return;
        }
        v.torque_Nm = leader.torque_Nm;
        v.gear_time_s = leader.gear_time_s;
        v.lag_s = leader.lag_s;
        v.gear = leader.gear;
    }

    World& w_;
    Routes& routes_;
    Entrance& entrance_;
    Perception perception_;
};

}  // namespace stopline::reference_engine
