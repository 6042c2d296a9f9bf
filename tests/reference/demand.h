// Draws of the reference engine: the spacing policy and the route of each vehicle.
#pragma once

#include <iterator>
#include <map>
#include <tuple>

#include "base/random.h"
#include "reference/network.h"

namespace stopline::reference_engine {

// Draws one of several components with given shares for each vehicle of an inlet. The vehicles of an inlet are
// numbered.
class ShareDraw {
public:
    ShareDraw(DemandPlan::Pattern pattern, std::uint64_t seed, Purpose purpose)
        : pattern_(pattern), seed_(seed), purpose_(purpose) {}

    // Returns the component of the k-th vehicle of an inlet. The shares sum to 1.
    std::size_t draw(const std::vector<double>& shares, int inlet, std::int64_t k) const {
        if (shares.size() == 1) return 0;
        if (pattern_ == DemandPlan::Pattern::alternating) return alternating(shares, k);
        if (pattern_ == DemandPlan::Pattern::random)
            return picked(shares, random_uniform(seed_, key(inlet, k), 0, purpose_));
        return picked(shares, balanced_number(inlet, k));
    }

private:
    static std::uint64_t key(int inlet, std::int64_t k) {
        return (static_cast<std::uint64_t>(inlet) << 40) + static_cast<std::uint64_t>(k);
    }

    // Each vehicle gets the component whose number of vehicles is furthest below its share.
    static std::size_t alternating(const std::vector<double>& shares, std::int64_t k) {
        std::vector<double> drawn(shares.size(), 0.0);
        std::size_t chosen = 0;
        for (std::int64_t n = 1; n <= k + 1; ++n) {
            const auto behind = [&](std::size_t c) { return shares[c] * static_cast<double>(n) - drawn[c]; };
            chosen = 0;
            for (std::size_t c = 1; c < drawn.size(); ++c) {
                if (behind(c) > behind(chosen) + 1e-9) chosen = c;
            }
            drawn[chosen] += 1.0;
        }
        return chosen;
    }
    static std::size_t picked(const std::vector<double>& shares, double number) {
        double upper = shares[0];
        std::size_t c = 0;
        while (number >= upper && c + 1 < shares.size()) upper += shares[++c];
        return c;
    }
    // Returns a number in [0, 1) for the k-th vehicle. The 20 vehicles of a block get numbers from 20 different
    // twentieths of [0, 1), in random order.
    double balanced_number(int inlet, std::int64_t k) const {
        const std::int64_t first = k / 20 * 20;
        const auto bits = [&](std::int64_t other) { return random_bits(seed_, key(inlet, other), 1, purpose_); };
        int rank = 0;
        for (std::int64_t other = first; other < first + 20; ++other) rank += bits(other) < bits(k) ? 1 : 0;
        return (rank + random_uniform(seed_, key(inlet, first), 2, purpose_)) / 20.0;
    }

    DemandPlan::Pattern pattern_;
    std::uint64_t seed_;
    Purpose purpose_;
};

// An inlet: a lane on which routes begin. Vehicles are numbered in the order in which they get their route.
struct Inlet {
    std::int64_t entered = 0;
    int next_policy = -1;  // of the next vehicle; -1: not drawn yet
    int next_route = -1;
    double last_entry_s = -1e9;
    std::int64_t blocked_number = -1;  // number of the vehicle that last found no room
};

// How a vehicle on a lane can make a turn.
struct TurnOption {
    int route = -1;        // begins on the lane; of several parallel routes, the last one; -1: none
    int lane_changes = 0;  // to the nearest lane with such a route; below 0: to the left
};

// The routes of vehicles, and the lanes that suit them. The rules are those of the comments in
// core/sim/lane_change/route_choice.cpp and preferred_lane.h.
class Routes {
public:
    explicit Routes(World& world)
        : w_(world),
          policy_draw_(world.model.demand.pattern, world.scenario.seed, Purpose::policy),
          route_draw_(world.model.demand.route_pattern, world.scenario.seed, Purpose::turn),
          inlets(world.model.demand.inlets.size()),
          drawn_(world.model.graph.approaches.size(), std::vector<double>(kMaxTurns, 0.0)) {
        for (auto route = static_cast<int>(w_.model.graph.routes.size()); route-- > 0;)
            routes_[{w_.route_of(route).front(), turn_of(route)}].push_back(route);
    }

    int policy_of(int inlet, std::int64_t k) const {
        const DemandPlan& demand = w_.model.demand;
        return demand.policies[policy_draw_.draw(demand.policy_shares, inlet, k)];
    }

    Turn turn_of(int route) const {
        const std::vector<int>& lanes = w_.route_of(route);
        return lanes.size() > 1 ? w_.lane(lanes[1]).turn : Turn::none;
    }

    // Returns all routes with a turn that begin on a lane, the last one first.
    const std::vector<int>& routes_on(int lane, Turn turn) const {
        static const std::vector<int> kNone;
        const auto found = routes_.find({lane, turn});
        return found == routes_.end() ? kNone : found->second;
    }

    TurnOption option(int lane, Turn turn) const {
        const std::vector<int>& own = routes_on(lane, turn);
        if (!own.empty()) return {own.front(), 0};
        const int approach = w_.lane(lane).approach;
        if (approach < 0) return {};
        const std::vector<int>& lanes = w_.model.graph.approaches[static_cast<std::size_t>(approach)].lanes;
        const auto count = static_cast<int>(lanes.size());
        const int index = w_.lane(lane).index;
        for (int distance = 1; distance < count; ++distance) {
            for (const int other : {index + distance, index - distance}) {
                if (other < 0 || other >= count) continue;
                if (!routes_on(lanes[static_cast<std::size_t>(other)], turn).empty()) return {-1, other - index};
            }
        }
        return {};
    }

    // Returns a route with a turn that begins on any lane of an approach, the last one of all; -1: none.
    int route_on_approach(int approach, Turn turn) const {
        int last = -1;
        for (const int lane : w_.model.graph.approaches[static_cast<std::size_t>(approach)].lanes) {
            const std::vector<int>& own = routes_on(lane, turn);
            if (!own.empty()) last = std::max(last, own.front());
        }
        return last;
    }

    // Returns the inlet of a lane; -1: no route begins there.
    int inlet_of(int lane) const {
        for (std::size_t k = 0; k < w_.model.demand.inlets.size(); ++k) {
            if (w_.model.demand.inlets[k].lane == lane) return static_cast<int>(k);
        }
        return -1;
    }

    // Draws the route of the k-th vehicle of an inlet. `chose_lane`: the vehicle is on the lane because of its turn.
    // Draws correct earlier deviations from the turn shares of the approach.
    int draw_route(int inlet, std::int64_t k, bool chose_lane) {
        constexpr double kBalanceVehicles = 4.0;
        const DemandPlan::Inlet& in = w_.model.demand.inlets[static_cast<std::size_t>(inlet)];
        std::vector<double> shares = chose_lane && !in.lane_shares.empty() ? in.lane_shares : in.shares;
        if (in.approach_shares.empty()) return in.routes[route_draw_.draw(shares, inlet, k)];
        std::vector<double>& drawn = drawn_[static_cast<std::size_t>(w_.lane(in.lane).approach)];
        const double total = std::accumulate(drawn.begin(), drawn.end(), 0.0);
        double sum = 0.0;
        for (std::size_t c = 0; c < shares.size(); ++c) {
            const double so_far = drawn[static_cast<std::size_t>(turn_of(in.routes[c]))];
            const double behind = (in.approach_shares[c] * total - so_far) / kBalanceVehicles;
            shares[c] = behind >= 0.0 ? shares[c] * (1.0 + behind) : shares[c] / (1.0 - behind);
            sum += shares[c];
        }
        for (double& share : shares) share /= sum;
        const int route = in.routes[route_draw_.draw(shares, inlet, k)];
        drawn[static_cast<std::size_t>(turn_of(route))] += 1.0;
        return route;
    }

    // Sets the route index, the next lane and the highest speed at the end of the lane.
    void set_route_index(Vehicle& v, int index) const {
        const std::vector<int>& route = w_.route_of(v.route);
        const auto next = static_cast<std::size_t>(index) + 1;
        v.route_index = index;
        v.next_lane = next < route.size() ? route[next] : -1;
        v.end_speed_mps = kNoLimit;
        if (v.next_lane < 0) return;
        const double end_mps = std::min(w_.lane(v.next_lane).entry_mps, lane_change_entry_mps(v, route, next));
        if (end_mps < w_.lane(route[next - 1]).limit_mps) v.end_speed_mps = stored(end_mps);
    }

    // Puts a vehicle on the route with its turn that begins on `lane`. Without such a route, the vehicle must change
    // lanes.
    void adopt_lane_route(int lane, Vehicle& v) const {
        update_preferred_lane(lane, v);
        const std::vector<int>& parallel = routes_on(lane, turn_of(v.route));
        if (!parallel.empty()) {
            v.route = best_parallel_route(parallel, v);
            return set_route_index(v, 0);
        }
        v.route_index = 0;
        v.next_lane = -1;
        v.end_speed_mps = kNoLimit;
    }

    // Draws the turns at the second and third intersection ahead, unless they are known.
    void draw_later_turns(int lane, Vehicle& v, bool chose_lane) {
        if (w_.driver(v).lane_change.look_ahead == "off") return;
        if (v.following_turn == Turn::none) v.following_turn = draw_turn_beyond(v.route, chose_lane);
        if (v.following_turn != Turn::none) {
            const int exit = w_.route_of(v.route).back();
            const int next_route = route_on_approach(w_.lane(exit).approach, v.following_turn);
            v.third_turn = next_route < 0 ? Turn::none : draw_turn_beyond(next_route, false);
        }
        update_preferred_lane(lane, v);
    }

    void enter_trip_edge(int lane, Vehicle& v, int edge) const {
        const DemandPlan& demand = w_.model.demand;
        v.trip_edge = edge;
        v.following_turn = demand.turn_of_trip(v.trip, edge + 1);
        v.route = route_on_approach(w_.lane(lane).approach, demand.turn_of_trip(v.trip, edge));
        adopt_lane_route(lane, v);
    }

    // Gives a vehicle that has entered a lane its next route, if routes begin on the lane.
    void choose_next_route(int lane, Vehicle& v) {
        if (v.trip >= 0) {
            if (!w_.lane(lane).is_connection()) enter_trip_edge(lane, v, v.trip_edge + 1);
            return;
        }
        const int inlet = inlet_of(lane);
        if (inlet < 0) return;
        const int known =
            v.following_turn == Turn::none ? -1 : route_on_approach(w_.lane(lane).approach, v.following_turn);
        v.route = known >= 0 ? known : draw_route(inlet, inlets[static_cast<std::size_t>(inlet)].entered++, false);
        v.following_turn = std::exchange(v.third_turn, Turn::none);
        adopt_lane_route(lane, v);
        draw_later_turns(lane, v, false);
    }

    // Returns the lane changes that a vehicle needs after the next intersection if it leaves the approach from `lane`:
    // for the next turn alone, and in total. Returns kNoTurn if the lane does not allow the present turn.
    static constexpr int kNoTurn = 100;
    std::pair<int, int> later_changes(int lane, const Vehicle& v) const {
        const TurnOption own = option(lane, turn_of(v.route));
        if (own.route < 0) return {kNoTurn, kNoTurn};
        if (v.trip >= 0) {
            const int changes = trip_changes_after(v.trip, v.trip_edge, lane);
            return {changes, changes};
        }
        const int exit = w_.route_of(own.route).back();
        if (v.following_turn == Turn::none || w_.lane(exit).approach < 0) return {0, 0};
        const int at_second = std::abs(option(exit, v.following_turn).lane_changes);
        int in_total = kNoTurn;
        for (const int other : w_.model.graph.approaches[static_cast<std::size_t>(w_.lane(exit).approach)].lanes) {
            const TurnOption there = option(other, v.following_turn);
            if (there.route < 0) continue;
            const int beyond = w_.route_of(there.route).back();
            const int after = v.third_turn == Turn::none ? 0 : std::abs(option(beyond, v.third_turn).lane_changes);
            in_total = std::min(in_total, std::abs(w_.lane(other).index - w_.lane(exit).index) + after);
        }
        return {at_second, in_total};
    }

    // Returns the lane changes that a trip needs on the edges after `edge` if the vehicle leaves this edge from `lane`.
    // Changes on later edges of 300 m or more do not count. 15: the lane does not allow the turn.
    int trip_changes_after(int trip, int edge, int lane) const {
        constexpr int kNoConnection = 15;
        const DemandPlan& demand = w_.model.demand;
        if (edge >= demand.trips[static_cast<std::size_t>(trip)].turn_count) return 0;
        const auto known = trip_changes_.find({trip, edge, lane});
        if (known != trip_changes_.end()) return known->second;
        int fewest = kNoConnection;
        for (const int route : routes_on(lane, demand.turn_of_trip(trip, edge))) {
            const int exit = w_.route_of(route).back();
            fewest = std::min({fewest, trip_changes_from(trip, edge + 1, exit, true), kNoConnection - 1});
        }
        trip_changes_[{trip, edge, lane}] = fewest;
        return fewest;
    }

    // Returns the lane changes on `edge` and later edges if the vehicle begins the edge on `lane`. `skips_long`:
    // changes on a long edge do not count.
    int trip_changes_from(int trip, int edge, int lane, bool skips_long) const {
        constexpr double kLongEdge_m = 300.0;
        if (skips_long && edge >= w_.model.demand.trips[static_cast<std::size_t>(trip)].turn_count) return 0;
        const std::vector<int>& lanes =
            w_.model.graph.approaches[static_cast<std::size_t>(w_.lane(lane).approach)].lanes;
        const bool is_long = skips_long && w_.lane(lanes.front()).stop_line_m >= kLongEdge_m;
        int fewest = 15;
        for (const int other : lanes) {
            const int beyond = trip_changes_after(trip, edge, other);
            const int here = is_long ? 0 : std::abs(w_.lane(other).index - w_.lane(lane).index);
            if (beyond != 15) fewest = std::min(fewest, here + beyond);
        }
        return fewest;
    }

private:
    // Trips: the speed from which the vehicle can stop on the exit lane of the route to change lanes there.
    double lane_change_entry_mps(const Vehicle& v, const std::vector<int>& route, std::size_t next) const {
        constexpr double kReaction_s = 0.5;
        const Lane& exit = w_.lane(route.back());
        if (v.trip < 0 || v.following_turn == Turn::none) return kNoLimit;
        const DriverSettings& driver = w_.driver(v);
        const double room_m = exit.stop_line_m - driver.stop.margin_m;
        if (option(exit.number, v.following_turn).lane_changes == 0 || room_m < v.length_m) return kNoLimit;
        double distance_m = room_m;
        for (std::size_t k = next; k + 1 < route.size(); ++k) distance_m += w_.lane(route[k]).length_m;
        const double bt = driver.stop.deceleration_mps2 * kReaction_s;
        return std::sqrt(bt * bt + 2.0 * driver.stop.deceleration_mps2 * distance_m) - bt;
    }

    // Among routes with the same turn, chooses one whose exit lane needs the fewest later lane changes. The id of the
    // vehicle decides between equal ones.
    int best_parallel_route(const std::vector<int>& routes, const Vehicle& v) const {
        if (routes.size() == 1) return routes.front();
        const auto changes = [&](int route) {
            const int exit = w_.route_of(route).back();
            return v.trip < 0 ? std::abs(option(exit, v.following_turn).lane_changes)
                              : trip_changes_from(v.trip, v.trip_edge + 1, exit, false);
        };
        int fewest = changes(routes.front());
        for (const int route : routes) fewest = std::min(fewest, changes(route));
        std::vector<int> best;
        std::copy_if(routes.begin(), routes.end(), std::back_inserter(best),
                     [&](int route) { return changes(route) == fewest; });
        return best[static_cast<std::size_t>(v.id) % best.size()];
    }

    // Draws a turn at the intersection beyond the exit lane of a route; none if there is no such intersection.
    Turn draw_turn_beyond(int route, bool chose_lane) {
        const int exit = w_.route_of(route).back();
        const int inlet = w_.lane(exit).approach < 0 ? -1 : inlet_of(exit);
        if (inlet < 0) return Turn::none;
        return turn_of(draw_route(inlet, inlets[static_cast<std::size_t>(inlet)].entered++, chose_lane));
    }

    // Sets Vehicle::preferred_offset: the nearest of the lanes from which the vehicle needs the fewest later lane
    // changes. All lanes up to it allow the present turn.
    void update_preferred_lane(int lane, Vehicle& v) const {
        v.preferred_offset = 0;
        const Lane& on = w_.lane(lane);
        if (v.following_turn == Turn::none || (on.left < 0 && on.right < 0)) return;
        const std::pair<int, int> here = later_changes(lane, v);
        if (here.second == kNoTurn) return;
        std::pair<int, int> best = here;
        for (const int step : {1, -1}) {
            int offset = 0;
            for (int other = step > 0 ? on.right : on.left; other >= 0;
                 other = step > 0 ? w_.lane(other).right : w_.lane(other).left) {
                const std::pair<int, int> there = later_changes(other, v);
                if (there.second == kNoTurn) break;
                offset += step;
                const bool is_nearer = there.second == best.second && std::abs(offset) < std::abs(v.preferred_offset);
                if (there.second > best.second || (there.second == best.second && !is_nearer)) continue;
                best = there;
                v.preferred_offset = offset;
            }
        }
        v.preferred_for_third = best.first == here.first;
    }

    World& w_;
    ShareDraw policy_draw_;
    ShareDraw route_draw_;

public:
    std::vector<Inlet> inlets;

private:
    std::vector<std::vector<double>> drawn_;                         // [approach][turn] number of draws
    std::map<std::pair<int, Turn>, std::vector<int>> routes_;        // [first lane, turn]
    mutable std::map<std::tuple<int, int, int>, int> trip_changes_;  // results of trip_changes_after()
};

}  // namespace stopline::reference_engine
