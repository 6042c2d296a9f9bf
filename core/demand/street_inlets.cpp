#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>

#include "demand/demand_plan.h"
#include "demand/turn_shares.h"

namespace stopline {

namespace {

constexpr std::array<Turn, 3> kTurns{Turn::straight, Turn::right, Turn::left};  // in the order of TurnShares

constexpr double kNobody = 1e-12;  // a share

std::size_t at(int index) { return static_cast<std::size_t>(index); }

TurnShares shares_of(const Approach& approach) {
    return {1.0 - approach.right - approach.left, approach.right, approach.left};
}

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

    int on(int lane, std::size_t turn) const { return of_[at(lane)][turn]; }

    // -1: no lane of the approach allows it.
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
    std::vector<std::array<int, 3>> of_;  // [lane][turn] route that begins there
};

DemandPlan::Inlet inlet_of(const Routes& routes, int lane, const TurnShares& shares, const TurnShares& all) {
    DemandPlan::Inlet inlet{lane, 0, {}, {}};
    for (std::size_t turn = 0; turn < shares.size(); ++turn) {
        if (shares[turn] <= kNobody) continue;
        inlet.routes.push_back(routes.nearest(lane, turn));
        inlet.shares.push_back(shares[turn]);
        inlet.approach_shares.push_back(all[turn]);
    }
    return inlet;
}

// Shares of the lanes of an approach by which vehicles come to it, which lie side by side; pockets beside them count with the nearest.
std::vector<TurnShares> lane_shares(const std::vector<int>& fed, const Routes& routes, const Approach& approach) {
    const auto enters = [&](int lane) { return std::find(fed.begin(), fed.end(), lane) != fed.end(); };
    std::vector<TurnsAllowed> allowed;
    TurnsAllowed of_pockets{};
    for (const int lane : approach.lanes) {
        TurnsAllowed own{};
        for (std::size_t turn = 0; turn < own.size(); ++turn) own[turn] = routes.on(lane, turn) >= 0;
        if (enters(lane)) allowed.push_back(own);
        TurnsAllowed& beside = allowed.empty() ? of_pockets : allowed.back();
        for (std::size_t turn = 0; turn < own.size(); ++turn) beside[turn] = beside[turn] || own[turn];
    }
    for (std::size_t turn = 0; turn < of_pockets.size(); ++turn) {
        allowed.front()[turn] = allowed.front()[turn] || of_pockets[turn];
    }
    return turns_by_lane(allowed, shares_of(approach));
}

}  // namespace

std::vector<DemandPlan::Inlet> street_inlets(const LaneGraph& graph) {
    const Routes routes(graph);
    std::vector<DemandPlan::Inlet> inlets;
    // Calls add(lane, its shares, the approach's) for lanes that are in the order of their approaches.
    const auto for_each = [&](const std::vector<int>& lanes, auto add) {
        std::vector<TurnShares> shares;
        int approach = -1;  // whose lanes these are
        std::size_t next = 0;
        for (const int lane : lanes) {
            if (graph.lanes[at(lane)].approach != approach) {
                approach = graph.lanes[at(lane)].approach;
                shares = lane_shares(lanes, routes, graph.approaches[at(approach)]);
                next = 0;
            }
            add(lane, shares[next++], shares_of(graph.approaches[at(approach)]));
        }
    };
    for_each(graph.entries, [&](int lane, const TurnShares& own, const TurnShares& all) {
        inlets.push_back(inlet_of(routes, lane, own, all));
    });
    for_each(graph.links, [&](int lane, const TurnShares& own, const TurnShares& all) {
        inlets.push_back(inlet_of(routes, lane, all, all));
        for (std::size_t turn = 0; turn < all.size(); ++turn) {
            if (all[turn] > kNobody) inlets.back().lane_shares.push_back(own[turn]);
        }
    });
    return inlets;
}

}  // namespace stopline
