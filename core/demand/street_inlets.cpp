// Makes the inlets of streets (lanes where vehicles get a route, see demand_plan.h), with routes and shares.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>

#include "base/containers/index.h"
#include "demand/demand_plan.h"
#include "demand/turn_shares.h"

namespace stopline {

namespace {

constexpr std::array<Turn, 3> kTurns{Turn::straight, Turn::right, Turn::left};  // in the order of TurnShares

constexpr double kMinShare = 1e-12;  // a smaller share counts as 0

TurnShares shares_of(const Approach& approach) {
    return {1.0 - approach.right_share - approach.left_share, approach.right_share, approach.left_share};
}

// Finds routes by approach lane and turn.
class Routes {
public:
    explicit Routes(const LaneGraph& graph) : graph_(graph), of_(graph.lanes.size(), {-1, -1, -1}) {
        for (int route = 0; route < static_cast<int>(graph.routes.size()); ++route) {
            const std::vector<int>& lanes = graph.routes[at(route)].lanes;
            const Turn turn = graph.lanes[at(lanes[1])].turn;
            const auto column = std::find(kTurns.begin(), kTurns.end(), turn) - kTurns.begin();
            of_[at(lanes[0])][static_cast<std::size_t>(column)] = route;
        }
    }

    // Returns the route with this turn that begins on the lane, or -1 if there is none.
    int on(int lane, std::size_t turn) const { return of_[at(lane)][turn]; }

    // Returns the route with this turn that begins on the nearest lane of the same approach, or -1 if no lane of the
    // approach allows the turn.
    int nearest(int lane, std::size_t turn) const {
        const std::vector<int>& lanes = graph_.approaches[at(graph_.lanes[at(lane)].approach)].lanes;
        const auto own = static_cast<int>(std::find(lanes.begin(), lanes.end(), lane) - lanes.begin());
        int best = -1;
        for (int k = 0; k < static_cast<int>(lanes.size()); ++k) {
            if (on(lanes[at(k)], turn) < 0) continue;
            if (best < 0 || std::abs(k - own) < std::abs(best - own)) best = k;
        }
        return best < 0 ? -1 : on(lanes[at(best)], turn);
    }

private:
    const LaneGraph& graph_;
    std::vector<std::array<int, 3>> of_;  // [lane][turn] route that begins on the lane; -1: none
};

DemandPlan::Inlet inlet_of(const Routes& routes, int lane, const TurnShares& shares,
                           const TurnShares& approach_shares) {
    DemandPlan::Inlet inlet{lane, 0, {}, {}};
    for (std::size_t turn = 0; turn < shares.size(); ++turn) {
        if (shares[turn] <= kMinShare) continue;
        inlet.routes.push_back(routes.nearest(lane, turn));
        inlet.shares.push_back(shares[turn]);
        inlet.approach_shares.push_back(approach_shares[turn]);
    }
    return inlet;
}

// Returns the turn shares for the inlet lanes of an approach, from the left. `is_inlet` marks the inlet lanes of the
// network. Inlet lanes of one approach are adjacent. Other lanes, such as pockets, lie beside the inlet lanes. A turn
// from such a lane is assigned to the nearest inlet lane.
std::vector<TurnShares> lane_shares(const std::vector<bool>& is_inlet, const Routes& routes, const Approach& approach) {
    std::vector<TurnsAllowed> allowed;
    TurnsAllowed left_pockets{};
    for (const int lane : approach.lanes) {
        TurnsAllowed own{};
        for (std::size_t turn = 0; turn < own.size(); ++turn) own[turn] = routes.on(lane, turn) >= 0;
        if (is_inlet[at(lane)]) allowed.push_back(own);
        TurnsAllowed& target = allowed.empty() ? left_pockets : allowed.back();
        for (std::size_t turn = 0; turn < own.size(); ++turn) target[turn] = target[turn] || own[turn];
    }
    for (std::size_t turn = 0; turn < left_pockets.size(); ++turn) {
        allowed.front()[turn] = allowed.front()[turn] || left_pockets[turn];
    }
    return turns_by_lane(allowed, shares_of(approach));
}

}  // namespace

std::vector<DemandPlan::Inlet> street_inlets(const LaneGraph& graph) {
    const Routes routes(graph);
    std::vector<DemandPlan::Inlet> inlets;
    // Calls add(lane, turn shares of the lane, turn shares of its approach) for each lane of the list. Lanes of the
    // same approach must be consecutive in the list.
    const auto for_each = [&](const std::vector<int>& lanes, auto add) {
        std::vector<bool> is_inlet(graph.lanes.size(), false);
        for (const int lane : lanes) is_inlet[at(lane)] = true;
        std::vector<TurnShares> shares;
        int approach = -1;
        std::size_t next = 0;
        for (const int lane : lanes) {
            if (graph.lanes[at(lane)].approach != approach) {
                approach = graph.lanes[at(lane)].approach;
                shares = lane_shares(is_inlet, routes, graph.approaches[at(approach)]);
                next = 0;
            }
            add(lane, shares[next++], shares_of(graph.approaches[at(approach)]));
        }
    };
    for_each(graph.entries, [&](int lane, const TurnShares& of_lane, const TurnShares& of_approach) {
        inlets.push_back(inlet_of(routes, lane, of_lane, of_approach));
    });
    for_each(graph.links, [&](int lane, const TurnShares& of_lane, const TurnShares& of_approach) {
        inlets.push_back(inlet_of(routes, lane, of_approach, of_approach));
        for (std::size_t turn = 0; turn < of_approach.size(); ++turn) {
            if (of_approach[turn] > kMinShare) inlets.back().lane_shares.push_back(of_lane[turn]);
        }
    });
    return inlets;
}

}  // namespace stopline
