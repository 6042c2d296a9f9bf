#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>

#include "demand/demand_plan.h"
#include "demand/turn_shares.h"

namespace stopline {

namespace {

constexpr std::array<Turn, 3> kTurns{Turn::straight, Turn::right, Turn::left};  // in the order of TurnShares

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

DemandPlan::Inlet inlet_of(const Routes& routes, int lane, const TurnShares& shares) {
    constexpr double kNobody = 1e-12;
    DemandPlan::Inlet inlet{lane, 0, {}, {}};
    for (std::size_t turn = 0; turn < shares.size(); ++turn) {
        if (shares[turn] <= kNobody) continue;
        inlet.routes.push_back(routes.nearest(lane, turn));
        inlet.shares.push_back(shares[turn]);
    }
    return inlet;
}

// Shares of the entry lanes of an approach, which lie side by side; pockets beside them count with the nearest.
std::vector<TurnShares> entry_shares(const LaneGraph& graph, const Routes& routes, const Approach& approach) {
    const auto enters = [&](int lane) {
        return std::find(graph.entries.begin(), graph.entries.end(), lane) != graph.entries.end();
    };
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
    std::vector<TurnShares> shares;
    int approach = -1;  // whose entries these are
    std::size_t next = 0;
    for (const int lane : graph.entries) {
        if (graph.lanes[at(lane)].approach != approach) {
            approach = graph.lanes[at(lane)].approach;
            shares = entry_shares(graph, routes, graph.approaches[at(approach)]);
            next = 0;
        }
        inlets.push_back(inlet_of(routes, lane, shares[next++]));
    }
    for (const int lane : graph.links) {
        inlets.push_back(inlet_of(routes, lane, shares_of(graph.approaches[at(graph.lanes[at(lane)].approach)])));
    }
    return inlets;
}

}  // namespace stopline
