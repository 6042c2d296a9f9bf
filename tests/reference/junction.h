// Right of way and keep-clear rule of the reference engine, for intersections where all vehicles go straight on. The
// streets that cross have green one after the other, so neither has priority. A vehicle keeps out of a conflict area
// while a vehicle of the crossing street is in it. If both vehicles still approach the area, the first one to pass its
// stop line has priority. The rules are those of the comments in core/sim/junction.
#pragma once

#include <tuple>
#include <utility>

#include "base/speed_thresholds.h"
#include "reference/demand.h"
#include "reference/world.h"

namespace stopline::reference_engine {

// A vehicle inside the intersection, or one that will pass its stop line without green. Positions are measured from the
// start of its connection.
struct Occupant {
    const Vehicle* vehicle = nullptr;
    std::pair<std::size_t, std::size_t> place;  // lane, and index on the lane
    double front_m = 0.0;
    double rear_m = 0.0;
    std::int64_t since = 0;  // tick at which the front passed the stop line
};

class Junction {
public:
    Junction(const Scenario& scenario, const std::vector<GapPolicy>& policies, double length_m)
        : scenario_(scenario), policies_(policies), length_m_(length_m) {}

    // Lists the occupants of each connection, the vehicle furthest downstream first. To be called before the decisions
    // at the stop lines.
    void find_occupants(const std::vector<Lane>& lanes, const std::vector<Signal>& signals, std::int64_t tick) {
        occupants_.assign(lanes.size(), {});
        for (std::size_t number = 0; number < lanes.size(); ++number) {
            if (lanes[number].origin < 0) continue;
            const Lane& connection = lanes[number];
            const auto add = [&](std::size_t lane, std::size_t k, double start_m, std::int64_t since) {
                const Vehicle& v = lanes[lane].vehicles[k];
                const double front_m = start_m + v.position_m;
                occupants_[number].push_back({&v, {lane, k}, front_m, front_m - length_m_, since});
            };
            const auto exit = static_cast<std::size_t>(connection.next);
            for (std::size_t k = 0; k < lanes[exit].vehicles.size(); ++k) {
                const Vehicle& v = lanes[exit].vehicles[k];
                if (v.position_m < length_m_) add(exit, k, connection.length_m, v.entry_tick);
            }
            for (std::size_t k = 0; k < connection.vehicles.size(); ++k)
                add(number, k, 0.0, connection.vehicles[k].entry_tick);
            const auto origin = static_cast<std::size_t>(connection.origin);
            const Lane& approach = lanes[origin];
            const Signal& signal = signals[static_cast<std::size_t>(approach.signal)];
            // In the step in which the light changes, no vehicle has been chosen to stop yet. So the vehicles on the
            // approach do not count.
            const bool has_changed = tick == 0 || signal.light(tick) != signal.light(tick - 1);
            if (signal.light(tick) == Light::green || has_changed) continue;
            for (std::size_t k = 0; k < approach.vehicles.size(); ++k) {
                if (approach.vehicles[k].id == approach.stopping_id) break;
                add(origin, k, -approach.length_m, tick);
            }
        }
    }

    // Keep-clear rule: sets Lane::stop_index to the first vehicle that must wait at green. A vehicle must wait while
    // its exit lane has no room for it, or while a slow vehicle of the crossing street blocks its path.
    void hold_for_keep_clear(const std::vector<Lane>& lanes, const std::vector<Signal>& signals, std::int64_t tick,
                             Lane& approach) {
        constexpr double kDecisionDistance_m = 80.0;
        const Lane& connection = lanes[static_cast<std::size_t>(approach.next)];
        if (scenario_.rules.keep_clear != "on" || connection.origin < 0) return;
        const bool is_blocked = has_crossing_blocker(lanes, signals, tick, connection);
        double room_m = exit_room_m(lanes, connection);
        for (std::size_t k = 0; k < approach.vehicles.size(); ++k) {
            const Vehicle& v = approach.vehicles[k];
            if (v.position_m < approach.length_m - kDecisionDistance_m) return;
            room_m -= space_m(v);
            if ((room_m >= 0.0 && !is_blocked) || !can_hold(approach, v)) continue;
            approach.stop_index = static_cast<std::ptrdiff_t>(k);
            ++holds_;
            return;
        }
    }

    // Sets Lane::yield_stops. To be called after the decisions at the stop lines.
    void decide(std::vector<Lane>& lanes, const std::vector<std::vector<Leader>>& leaders, std::int64_t tick) {
        constexpr double kLookBack_m = 60.0;
        constexpr std::int64_t kMemory_ticks = 5;
        lanes_ = &lanes;
        leaders_ = &leaders;
        tick_ = tick;
        std::erase_if(resolutions_, [&](const Resolution& r) { return tick - r.last_tick > kMemory_ticks; });
        for (Lane& lane : lanes) lane.yield_stops.clear();
        for (std::size_t number = 0; number < lanes.size(); ++number) {
            if (lanes[number].origin < 0) continue;
            Lane& connection = lanes[number];
            for (std::size_t k = 0; k < connection.vehicles.size(); ++k) decide_vehicle(number, number, k, 0.0);
            const auto origin = static_cast<std::size_t>(connection.origin);
            Lane& approach = lanes[origin];
            const double to_first_m = connection.conflicts.front().from_m - margin_m();
            const bool has_others = has_crossing_occupants(connection);
            for (std::size_t k = 0; has_others && k < approach.vehicles.size(); ++k) {
                const Vehicle& v = approach.vehicles[k];
                const double to_end_m = approach.length_m - v.position_m;
                if (to_end_m > kLookBack_m || static_cast<std::ptrdiff_t>(k) == approach.stop_index) break;
                if (to_end_m + to_first_m <= decision_distance_m(v.speed_mps))
                    decide_vehicle(number, origin, k, -approach.length_m);
            }
        }
        resolve_deadlocks();
    }

    // Returns the number of vehicle steps in which the keep-clear rule has held a vehicle.
    std::int64_t holds() const { return holds_; }
    // Returns in how many steps a deadlock was resolved.
    std::int64_t resolved() const { return resolved_; }
    // Returns how many vehicles have begun to wait before a conflict area.
    std::int64_t waits() const { return waits_; }

private:
    // The ids of two vehicles that wait for each other. Vehicle `proceeds` drives on, and vehicle `yields` waits.
    struct Resolution {
        int proceeds = -1;
        int yields = -1;
        std::int64_t last_tick = 0;
    };

    // Returns the space that a stopped vehicle needs, with the gap to its leader.
    double space_m(const Vehicle& v) const {
        return length_m_ + stored(policies_[static_cast<std::size_t>(v.policy)].settings.standstill_gap_m);
    }

    // Returns the free length of the exit lane behind its last slow vehicle, minus the space for all vehicles that
    // drive towards this vehicle. If no slow vehicle is in sight, the exit lane counts as endless.
    double exit_room_m(const std::vector<Lane>& lanes, const Lane& connection) const {
        constexpr double kEndless_m = 1e9;
        double moving_m = 0.0;
        const std::deque<Vehicle>& vehicles = lanes[static_cast<std::size_t>(connection.next)].vehicles;
        for (auto v = vehicles.rbegin(); v != vehicles.rend(); ++v) {
            const double rear_m = v->position_m - length_m_;
            if (rear_m > scenario_.rules.sight_m) return kEndless_m;
            if (v->speed_mps < kCrawlingSpeed_mps) {
                double room_m = rear_m - moving_m;
                for (const Vehicle& inside : connection.vehicles) room_m -= space_m(inside);
                return room_m;
            }
            moving_m += space_m(*v);
        }
        return kEndless_m;
    }

    // Returns true if a slow vehicle of the crossing street is in a conflict area of the connection, or has waited
    // before it since an earlier green.
    bool has_crossing_blocker(const std::vector<Lane>& lanes, const std::vector<Signal>& signals, std::int64_t tick,
                              const Lane& connection) const {
        for (const Conflict& conflict : connection.conflicts) {
            const auto other = static_cast<std::size_t>(conflict.other);
            const Lane& origin = lanes[static_cast<std::size_t>(lanes[other].origin)];
            const bool is_red = signals[static_cast<std::size_t>(origin.signal)].light(tick) == Light::red;
            for (const Occupant& occupant : occupants_[other]) {
                if (occupant.vehicle->speed_mps >= kCrawlingSpeed_mps || occupant.rear_m >= conflict.other_to_m)
                    continue;
                if (occupant.front_m > conflict.other_from_m) return true;
                if (is_red && (is_inside(lanes, occupant) || occupant.vehicle->id != origin.stopping_id)) return true;
            }
        }
        return false;
    }

    static bool is_inside(const std::vector<Lane>& lanes, const Occupant& occupant) {
        return lanes[occupant.place.first].signal < 0;
    }

    // Returns true if the vehicle can still stop at the line for the keep-clear rule.
    bool can_hold(const Lane& approach, const Vehicle& v) const {
        constexpr double kLagFactor = 1.4;
        const CaccSettings& cacc = scenario_.driver.cacc;
        const double peak_mps2 =
            std::min(kLagFactor * scenario_.driver.stop.deceleration_mps2, cacc.deceleration_emergency_mps2);
        if (peak_mps2 <= cacc.deceleration_comfort_mps2)
            return can_stop_before(v, approach, scenario_, cacc.deceleration_comfort_mps2);
        if (!scenario_.is_meso()) return can_stop_before(v, approach, scenario_, peak_mps2);
        return v.speed_mps * v.speed_mps <= 2.0 * peak_mps2 * (approach.length_m - v.position_m);
    }

    double margin_m() const { return scenario_.driver.give_way.margin_m; }
    double decision_distance_m(double speed_mps) const {
        return 0.5 * speed_mps * speed_mps / scenario_.driver.stop.deceleration_mps2 + 1.5 * speed_mps + 3.0;
    }
    bool has_crossing_occupants(const Lane& connection) const {
        return std::any_of(connection.conflicts.begin(), connection.conflicts.end(), [&](const Conflict& conflict) {
            return !occupants_[static_cast<std::size_t>(conflict.other)].empty();
        });
    }
    bool is_yielding(const Vehicle& v) const { return v.yield_tick >= tick_ - 1 && v.speed_mps < kCrawlingSpeed_mps; }

    // Decides whether a vehicle waits before a conflict area of its connection, and adds its yield stop to its lane.
    // `start_m`: start of this lane, measured from the start of the connection.
    void decide_vehicle(std::size_t connection, std::size_t lane, std::size_t k, double start_m) {
        Vehicle& v = (*lanes_)[lane].vehicles[k];
        const double front_m = start_m + v.position_m;
        const Occupant own{&v, {lane, k}, front_m, front_m - length_m_, v.entry_tick};
        for (const Conflict& conflict : (*lanes_)[connection].conflicts) {
            if (front_m > conflict.from_m) continue;
            const double place_m = conflict.from_m - margin_m();
            if (place_m - front_m > decision_distance_m(v.speed_mps)) return;
            const std::vector<Occupant>& others = occupants_[static_cast<std::size_t>(conflict.other)];
            const auto blocks = [&](const Occupant& other) { return blocks_area(conflict, own, other); };
            const auto blocker = std::find_if(others.begin(), others.end(), blocks);
            if (blocker == others.end()) continue;
            (*lanes_)[lane].yield_stops.push_back(
                {static_cast<std::ptrdiff_t>(k), place_m - start_m, blocker->vehicle->id});
            waits_ += v.yield_tick < tick_ - 1 ? 1 : 0;
            if (v.yield_tick < tick_ - 1 || v.speed_mps >= kCrawlingSpeed_mps) v.wait_since_tick = tick_;
            v.yield_tick = tick_;
            return;
        }
    }

    // Returns true if `other` keeps `own` out of the conflict area.
    bool blocks_area(const Conflict& conflict, const Occupant& own, const Occupant& other) {
        if (other.rear_m >= conflict.other_to_m) return false;
        if (other.front_m > conflict.other_from_m) return true;
        const Lane& others_lane = (*lanes_)[other.place.first];
        // The other vehicle stops at its line.
        if (others_lane.signal >= 0 && static_cast<std::ptrdiff_t>(other.place.second) == others_lane.stop_index)
            return false;
        // If only one of the two vehicles can stop before the area, it waits.
        const bool own_can_stop = can_stop_within(own, conflict.from_m);
        if (own_can_stop != can_stop_within(other, conflict.other_from_m)) return own_can_stop;
        if (resolution(*other.vehicle, *own.vehicle) != nullptr) return true;
        if (Resolution* const known = resolution(*own.vehicle, *other.vehicle)) {
            known->last_tick = tick_;
            return false;
        }
        const bool is_stopped = own.vehicle->speed_mps < kCrawlingSpeed_mps;
        if (is_stopped && (is_yielding(*other.vehicle) || is_behind_yielding_vehicle(other))) {
            resolutions_.push_back({own.vehicle->id, other.vehicle->id, tick_});
            return false;
        }
        return !is_inside(*lanes_, own) || std::tie(other.since, other.place) < std::tie(own.since, own.place);
    }

    bool can_stop_within(const Occupant& occupant, double area_m) const {
        constexpr double kResponse_s = 0.3;
        const double speed_mps = occupant.vehicle->speed_mps;
        const double braking_m = 0.5 * speed_mps * speed_mps / scenario_.driver.cacc.deceleration_emergency_mps2;
        const double response_m = scenario_.is_meso() ? 0.0 : kResponse_s * speed_mps;
        return braking_m + response_m <= area_m - occupant.front_m;
    }

    // A lane, and the index of a vehicle on it.
    using Place = std::pair<std::size_t, std::size_t>;

    Place place_of(int id) const {
        for (std::size_t lane = 0; lane < lanes_->size(); ++lane) {
            for (std::size_t k = 0; k < (*lanes_)[lane].vehicles.size(); ++k) {
                if ((*lanes_)[lane].vehicles[k].id == id) return {lane, k};
            }
        }
        return {0, 0};  // never reached: the vehicle is in the network
    }

    // Returns the leader of a vehicle if both are slow and their gap is short; else null.
    const Vehicle* blocking_leader(const Vehicle& v) const {
        const double standstill_m = stored(policies_[static_cast<std::size_t>(v.policy)].settings.standstill_gap_m);
        const double close_m = std::max(6.0, standstill_m + 3.0);
        const auto [lane, k] = place_of(v.id);
        const Leader& leader = (*leaders_)[lane][k];
        const bool blocks = leader.vehicle != nullptr && v.speed_mps < kCrawlingSpeed_mps &&
                            leader.speed_mps < kCrawlingSpeed_mps && leader.gap_m < close_m;
        return blocks ? leader.vehicle : nullptr;
    }

    // Returns true if the vehicle stands in a queue behind a vehicle that waits before a conflict area.
    bool is_behind_yielding_vehicle(const Occupant& occupant) const {
        constexpr int kMaxQueue = 8;
        const Vehicle* v = occupant.vehicle;
        for (int n = 0; n < kMaxQueue; ++n) {
            v = blocking_leader(*v);
            if (v == nullptr) return false;
            if (is_yielding(*v)) return true;
        }
        return false;
    }

    // A vehicle and its blocker: the vehicle that it waits for.
    struct Waiting {
        const Vehicle* vehicle = nullptr;
        const Vehicle* blocker = nullptr;      // null: it waits for nobody
        bool needs_only_right_of_way = false;  // true: the blocker is not in the conflict area yet
    };

    Waiting waiting(const Vehicle& v) const {
        if (v.speed_mps >= kCrawlingSpeed_mps) return {&v};
        const auto [lane, k] = place_of(v.id);
        for (const YieldPlace& stop : (*lanes_)[lane].yield_stops) {
            if (stop.index != static_cast<std::ptrdiff_t>(k)) continue;
            const auto [blocker_lane, blocker_k] = place_of(stop.blocker_id);
            const Vehicle& blocker = (*lanes_)[blocker_lane].vehicles[blocker_k];
            return {&v, &blocker, !is_in_area(lane, blocker_lane, blocker)};
        }
        return {&v, blocking_leader(v)};
    }

    // Returns true if the front of the blocker has reached the conflict area of its connection and the connection of a
    // vehicle on `lane`. Also returns true if these connections do not cross.
    bool is_in_area(std::size_t lane, std::size_t blocker_lane, const Vehicle& blocker) const {
        const auto connection_of = [&](std::size_t number) {
            return (*lanes_)[number].origin >= 0 ? static_cast<int>(number) : (*lanes_)[number].next;
        };
        const double start_m = (*lanes_)[blocker_lane].signal >= 0 ? -(*lanes_)[blocker_lane].length_m : 0.0;
        for (const Conflict& conflict : (*lanes_)[static_cast<std::size_t>(connection_of(lane))].conflicts) {
            if (conflict.other == connection_of(blocker_lane))
                return start_m + blocker.position_m > conflict.other_from_m;
        }
        return true;
    }

    // If slow vehicles wait for each other in a cycle, lets one of them proceed. The candidates are the vehicles whose
    // blocker has not reached the conflict area yet. The candidate that has waited longest proceeds.
    void resolve_deadlocks() {
        for (const Lane& lane : *lanes_) {
            for (const YieldPlace& stop : lane.yield_stops) {
                resolve_cycle(lane.vehicles[static_cast<std::size_t>(stop.index)]);
            }
        }
    }

    void resolve_cycle(const Vehicle& start) {
        constexpr std::size_t kMaxCycle = 16;
        if (start.speed_mps >= kCrawlingSpeed_mps) return;
        std::vector<Waiting> cycle{waiting(start)};
        while (cycle.back().blocker != nullptr && cycle.back().blocker != &start) {
            if (cycle.size() == kMaxCycle) return;
            cycle.push_back(waiting(*cycle.back().blocker));
        }
        if (cycle.back().blocker == nullptr) return;
        const auto rank = [](const Waiting& w) {
            return std::tuple(!w.needs_only_right_of_way, w.vehicle->wait_since_tick, w.vehicle->id);
        };
        const Waiting first = *std::min_element(cycle.begin(), cycle.end(),
                                                [&](const Waiting& a, const Waiting& b) { return rank(a) < rank(b); });
        if (!first.needs_only_right_of_way || first.vehicle != &start) return;
        ++resolved_;
        if (Resolution* const known = resolution(start, *first.blocker)) {
            known->last_tick = tick_;
        } else {
            resolutions_.push_back({start.id, first.blocker->id, tick_});
        }
    }

    Resolution* resolution(const Vehicle& proceeds, const Vehicle& yields) {
        const auto found = std::find_if(resolutions_.begin(), resolutions_.end(), [&](const Resolution& r) {
            return r.proceeds == proceeds.id && r.yields == yields.id;
        });
        return found == resolutions_.end() ? nullptr : &*found;
    }

    Scenario scenario_;
    const std::vector<GapPolicy>& policies_;
    double length_m_;
    std::vector<std::vector<Occupant>> occupants_;  // [connection]
    std::vector<Resolution> resolutions_;
    std::int64_t waits_ = 0;
    std::int64_t holds_ = 0;
    std::int64_t resolved_ = 0;
    // The present step.
    std::vector<Lane>* lanes_ = nullptr;
    const std::vector<std::vector<Leader>>* leaders_ = nullptr;
    std::int64_t tick_ = 0;
};

}  // namespace stopline::reference_engine
