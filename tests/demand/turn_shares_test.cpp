// Tests of turn shares by lane against calculations by hand.
#include "demand/turn_shares.h"

#include <gtest/gtest.h>

#include "demand/demand_plan.h"
#include "network/lane_graph.h"
#include "support/streets.h"

namespace stopline {
namespace {

constexpr TurnsAllowed kStraightLeft{true, false, true};
constexpr TurnsAllowed kStraight{true, false, false};
constexpr TurnsAllowed kStraightRight{true, true, false};
constexpr TurnsAllowed kLeft{false, false, true};

void expect_row(const TurnShares& row, const TurnShares& expected) {
    for (std::size_t turn = 0; turn < row.size(); ++turn) EXPECT_NEAR(row[turn], expected[turn], 1e-9) << turn;
}

// Each lane carries 33.3 % of the traffic. 8 % turn left from the left lane, and 12 % turn right from the right lane.
TEST(TurnsByLane, FillLanesEvenly) {
    const auto lanes = turns_by_lane({kStraightLeft, kStraight, kStraightRight}, {0.8, 0.12, 0.08});
    expect_row(lanes[0], {0.76, 0.0, 0.24});
    expect_row(lanes[1], {1.0, 0.0, 0.0});
    expect_row(lanes[2], {0.64, 0.36, 0.0});
}

// turns_by_lane() fits the shares iteratively. In each step it multiplies all shares of a lane, or of a turn, by one
// factor, so two lanes with the same movements keep equal shares.
TEST(TurnsByLane, AreEqualForEqualLanes) {
    const auto lanes = turns_by_lane({{true, true, true}, {true, true, true}}, {0.5, 0.3, 0.2});
    expect_row(lanes[0], {0.5, 0.3, 0.2});
    expect_row(lanes[1], {0.5, 0.3, 0.2});
}

// The left-turn lane carries 30 % of the traffic, the other two lanes 35 % each. The third lane carries 5 % that go
// straight and 30 % that turn right. No vehicle enters on a lane that does not serve its turn.
TEST(TurnsByLane, AreServedByTheLane) {
    const auto lanes = turns_by_lane({kLeft, kStraight, kStraightRight}, {0.4, 0.3, 0.3});
    expect_row(lanes[0], {0.0, 0.0, 1.0});
    expect_row(lanes[1], {1.0, 0.0, 0.0});
    expect_row(lanes[2], {5.0 / 35.0, 30.0 / 35.0, 0.0});
}

TEST(TurnsByLane, OfAnUnusedTurnLaneEqualTheApproachShares) {
    expect_row(turns_by_lane({kLeft, kStraight}, {1.0, 0.0, 0.0})[0], {1.0, 0.0, 0.0});
}

TEST(TurnsByLane, OfASingleLaneEqualTheApproachShares) {
    expect_row(turns_by_lane({{true, true, true}}, {0.75, 0.16, 0.09})[0], {0.75, 0.16, 0.09});
}

double share_of(const LaneGraph& graph, const DemandPlan::Inlet& inlet, Turn turn) {
    for (std::size_t k = 0; k < inlet.routes.size(); ++k) {
        const auto& route = graph.routes[static_cast<std::size_t>(inlet.routes[k])].lanes;
        if (graph.lanes[static_cast<std::size_t>(route[1])].turn == turn) return inlet.shares[k];
    }
    return 0.0;
}

// Left-turning vehicles enter on the lane beside the pocket. Their route begins in the pocket.
TEST(StreetInlets, PutPocketTrafficOnTheNeighbouringLane) {
    const LaneGraph graph = make_streets(streets_with_pockets());
    const std::vector<DemandPlan::Inlet> inlets = street_inlets(graph);
    ASSERT_EQ(inlets.size(), graph.entries.size() + graph.links.size());
    EXPECT_EQ(graph.lanes[static_cast<std::size_t>(inlets[0].lane)].name, "first_west_in_1");
    EXPECT_NEAR(share_of(graph, inlets[0], Turn::left), 0.24, 1e-9);
    EXPECT_NEAR(share_of(graph, inlets[0], Turn::straight), 0.76, 1e-9);
    EXPECT_EQ(share_of(graph, inlets[1], Turn::left), 0.0);
    EXPECT_NEAR(share_of(graph, inlets[2], Turn::right), 0.36, 1e-9);
    const auto& route = graph.routes[static_cast<std::size_t>(inlets[0].routes.back())].lanes;
    EXPECT_EQ(graph.lanes[static_cast<std::size_t>(route[0])].name, "first_west_in_0");
}

// Vehicles can also enter on a link between two intersections. On every lane of the link the turns have the shares of
// the whole approach. A route begins on the lane where the vehicle enters if this lane serves the turn.
TEST(StreetInlets, UseTheApproachSharesOnLinks) {
    const LaneGraph graph = make_streets(two_streets());
    const std::vector<DemandPlan::Inlet> inlets = street_inlets(graph);
    for (std::size_t k = graph.entries.size(); k < inlets.size(); ++k) {
        EXPECT_NEAR(share_of(graph, inlets[k], Turn::straight), 0.8, 1e-12);
        EXPECT_NEAR(share_of(graph, inlets[k], Turn::right), 0.12, 1e-12);
        EXPECT_NEAR(share_of(graph, inlets[k], Turn::left), 0.08, 1e-12);
        EXPECT_EQ(graph.routes[static_cast<std::size_t>(inlets[k].routes[0])].lanes[0], inlets[k].lane);
    }
}

}  // namespace
}  // namespace stopline
