#include "sim/lane_plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "base/arithmetic.h"

namespace stopline {

namespace {

std::size_t at(int index) { return static_cast<std::size_t>(index); }

// Lanes that depend on each other, as sets that are joined.
class Sets {
public:
    explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

    // The set's lowest member.
    int of(int member) {
        while (parent_[at(member)] != member) {
            parent_[at(member)] = parent_[at(parent_[at(member)])];
            member = parent_[at(member)];
        }
        return member;
    }
    void join(int a, int b) {
        const int one = of(a);
        const int other = of(b);
        parent_[at(std::max(one, other))] = std::min(one, other);
    }

private:
    std::vector<int> parent_;
};

LanePlan plan_of(const Model& model, int index) {
    const Lane& lane = model.graph.lanes[at(index)];
    LanePlan plan;
    plan.length_m = lane.length_m;
    plan.stop_line_m = lane.stop_line_m;
    plan.turn_m = lane.signal_group >= 0 ? lane.stop_line_m : lane.length_m;
    plan.limit_mps = lane.limit_mps;
    plan.sine = static_cast<float>(lane.gradient / std::sqrt(1.0 + square(lane.gradient)));
    plan.signal_group = lane.signal_group;
    plan.origin = lane.origin;
    plan.branches = lane.next.size() > 1;
    if (lane.origin >= 0) plan.exit = lane.next[0];
    plan.keeps_clear = lane.keeps_clear;
    const auto has_light = [&](int next) { return model.graph.lanes[at(next)].light >= 0; };
    plan.by_way = lane.origin < 0 && std::any_of(lane.next.begin(), lane.next.end(), has_light);
    for (const Conflict& conflict : model.graph.conflicts_of(index)) {
        plan.first_area_m = std::min(plan.first_area_m, conflict.from_m);
        plan.yields = plan.yields || conflict.yields;
    }
    return plan;
}

double longest_vehicle_m(const Model& model) {
    double longest_m = 0.0;
    for (const PowertrainTables& type : model.vehicles) longest_m = std::max(longest_m, type.length_m);
    for (const Trip& trip : model.demand.trips) longest_m = std::max(longest_m, static_cast<double>(trip.length_m));
    return longest_m;
}

double needs_at_most(const Model& model) {
    double gap_m = 0.0;
    for (const CompiledPolicy& policy : model.policies) gap_m = std::max(gap_m, policy.settings.standstill_gap_m);
    return longest_vehicle_m(model) + gap_m;
}

// Lanes inside depend on those that lead there and on those that they meet. An exit that leads nowhere goes with them, to be near.
void join_intersections(const Model& model, Sets& sets) {
    for (int index = 0; index < static_cast<int>(model.graph.lanes.size()); ++index) {
        const Lane& lane = model.graph.lanes[at(index)];
        if (lane.origin < 0) continue;
        sets.join(index, lane.origin);
        for (const Conflict& conflict : model.graph.conflicts_of(index)) sets.join(index, conflict.other);
        if (model.graph.lanes[at(lane.next[0])].signal_group < 0) sets.join(index, lane.next[0]);
    }
    for (const Approach& approach : model.graph.approaches) {
        for (const int lane : approach.lanes) sets.join(approach.lanes[0], lane);
    }
}

// How far it is from each lane of an approach to one from which there is a way on with a turn.
void count_changes(const Approach& approach, std::size_t turn, std::vector<BesidePlan>& beside) {
    const auto lanes = static_cast<int>(approach.lanes.size());
    const auto way = [&](int k) -> WayOn& { return beside[at(approach.lanes[at(k)])].ways[turn]; };
    for (int k = 0; k < lanes; ++k) {
        for (int distance = 0; distance < lanes && way(k).route < 0 && way(k).changes == 0; ++distance) {
            if (k + distance < lanes && way(k + distance).route >= 0) {
                way(k).changes = distance;
            } else if (k >= distance && way(k - distance).route >= 0) {
                way(k).changes = -distance;
            }
        }
    }
}

// Routes from one lane with one turn are chained by `like`, the last one first.
std::vector<BesidePlan> plan_beside(const LaneGraph& graph, const std::vector<Turn>& turns, std::vector<int>& like) {
    std::vector<BesidePlan> beside(graph.lanes.size());
    for (std::size_t lane = 0; lane < graph.lanes.size(); ++lane) {
        beside[lane].left = graph.lanes[lane].left;
        beside[lane].right = graph.lanes[lane].right;
        beside[lane].begin_m = graph.lanes[lane].begin_m;
    }
    for (std::size_t route = 0; route < graph.routes.size(); ++route) {
        int& own = beside[at(graph.routes[route].lanes[0])].ways[static_cast<std::size_t>(turns[route])].route;
        like.push_back(own);
        own = static_cast<int>(route);
    }
    for (const Approach& approach : graph.approaches) {
        for (std::size_t k = 0; k < approach.lanes.size(); ++k)
            beside[at(approach.lanes[k])].place = static_cast<int>(k);
        for (std::size_t turn = 0; turn < beside[0].ways.size(); ++turn) count_changes(approach, turn, beside);
    }
    return beside;
}

}  // namespace

NetworkPlan::NetworkPlan(const Model& model)
    : speed_factor_(model.speed_factor), needs_at_most_m_(needs_at_most(model)), demand_(&model.demand) {
    const auto count = static_cast<int>(model.graph.lanes.size());
    const double longest_m = longest_vehicle_m(model);
    Sets sets(at(count));
    join_intersections(model, sets);
    for (int lane = 0; lane < count; ++lane) {
        lanes_.push_back(plan_of(model, lane));
        intersection_of_.push_back(sets.of(lane));
        intersections_ += sets.of(lane) == lane ? 1 : 0;
        order_.push_back(lane);
        waits_inside_.push_back(model.graph.lanes[at(lane)].waits_inside ? 1 : 0);
        lights_.push_back(model.graph.lanes[at(lane)].light);
        const Lane& each = model.graph.lanes[at(lane)];
        parting_.push_back({each.clear_m, each.origin >= 0 && each.length_m - each.clear_m < longest_m});
        next_.add(model.graph.lanes[at(lane)].next);
        conflicts_.add(model.graph.conflicts_of(lane));
    }
    std::stable_sort(order_.begin(), order_.end(),
                     [this](int a, int b) { return intersection_of(a) < intersection_of(b); });
    number_inside(model);
    for (const Route& route : model.graph.routes) {
        routes_.add(route.lanes);
        turns_.push_back(route.lanes.size() > 1 ? model.graph.lanes[at(route.lanes[1])].turn : Turn::none);
    }
    beside_ = plan_beside(model.graph, turns_, like_);
    for (const Approach& approach : model.graph.approaches) {
        std::array<int, kMostTurns> routes{};
        routes.fill(-1);
        for (const int lane : approach.lanes) {
            for (std::size_t turn = 0; turn < routes.size(); ++turn) {
                routes[turn] = std::max(routes[turn], beside_[at(lane)].ways[turn].route);
            }
        }
        routes_with_.push_back(routes);
    }
    for (const int lane : order_) {
        if (beside_[at(lane)].changes()) changing_.push_back(lane);
    }
    if (!model.demand.trips.empty()) trip_lanes_ = TripLanes(model, *this);
}

void NetworkPlan::number_inside(const Model& model) {
    int intersection = -1;
    for (const int lane : order_) {
        if (lanes_[at(lane)].origin < 0 || model.graph.conflicts_of(lane).empty()) continue;
        if (intersection_of(lane) != intersection) {
            marked_.resize((marked_.size() + Marks::kBits - 1) / Marks::kBits * Marks::kBits, -1);
            intersection = intersection_of(lane);
        }
        lanes_[at(lane)].mark = static_cast<int>(marked_.size());
        marked_.push_back(lane);
    }
    for (std::size_t lane = 0; lane < lanes_.size(); ++lane) {
        std::vector<NumbersOfWord> meets;
        for (const Conflict& conflict : model.graph.conflicts_of(static_cast<int>(lane))) {
            const int mark = lanes_[at(conflict.other)].mark;
            if (mark < 0) continue;
            const std::size_t word = at(mark) / Marks::kBits;
            auto of_word = std::find_if(meets.begin(), meets.end(), [&](const auto& m) { return m.word == word; });
            if (of_word == meets.end()) of_word = meets.insert(of_word, {word, 0});
            of_word->bits |= std::uint64_t{1} << at(mark) % Marks::kBits;
        }
        meets_.add(meets);
    }
}

}  // namespace stopline
