// Tests of make_streets(): lengths and positions in closed form, neighbours, pockets, routes, conflicts.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "network/lane_graph.h"
#include "support/streets.h"

namespace stopline {
namespace {

int find(const LaneGraph& graph, const std::string& name) {
    for (std::size_t k = 0; k < graph.lanes.size(); ++k) {
        if (graph.lanes[k].name == name) return static_cast<int>(k);
    }
    ADD_FAILURE() << "no lane " << name;
    return 0;
}

const Lane& lane(const LaneGraph& graph, const std::string& name) { return graph.lanes[at(find(graph, name))]; }

TEST(Streets, HaveTheExpectedLanesEntriesLinksAndRoutes) {
    const LaneGraph graph = make_streets(two_streets());
    check(graph);
    EXPECT_EQ(graph.signal_groups, 6);
    EXPECT_EQ(graph.stage_of, (std::vector<int>{0, 0, 1, 2, 2, 3}));
    EXPECT_EQ(graph.entries.size(), 2u * 3 + 4);  // west of the first, east of the second, four minor legs
    EXPECT_EQ(graph.links.size(), 2u * 3);
    EXPECT_EQ(graph.routes.size(), 2u * (2 * 5 + 2 * 3));
    EXPECT_EQ(graph.lanes.size(), 2u * 8 + (2 * 3 + 4) + 2 * 16);  // approach lanes, exit lanes, connections
    EXPECT_EQ(graph.approaches.size(), 8u);
    EXPECT_EQ(graph.approaches[0].name, "first_west");
    EXPECT_EQ(graph.approaches[0].right_share, 0.12);
    EXPECT_EQ(graph.approaches[0].left_share, 0.08);
}

TEST(Streets, LaneLengthsMatchTheRoad) {
    StreetSettings streets = two_streets();
    streets.intersections[1].radius_m = 25.0;
    streets.intersections[0].legs[0].length_m = 320.0;
    streets.intersections[1].legs[1].exit_length_m = 80.0;
    const LaneGraph graph = make_streets(streets);
    EXPECT_NEAR(lane(graph, "second_west_in_1").stop_line_m, 200.0 - 20.0 - 25.0, 1e-9);
    EXPECT_NEAR(lane(graph, "first_east_in_1").stop_line_m, 200.0 - 20.0 - 25.0, 1e-9);
    EXPECT_NEAR(lane(graph, "first_west_in_0").stop_line_m, 320.0, 1e-9);
    EXPECT_NEAR(lane(graph, "second_east_out_2").length_m, 80.0, 1e-9);
    EXPECT_NEAR(lane(graph, "first_west_1_straight").length_m, 40.0, 1e-9);
    for (const Lane& this_lane : graph.lanes) {
        EXPECT_NEAR(length_m(this_lane.shape),
                    this_lane.origin < 0 && this_lane.signal_group >= 0 ? this_lane.stop_line_m
                                                                        : this_lane.length_m + this_lane.shape_start_m,
                    1e-9)
            << this_lane.name;
    }
}

// The movements of a lane share a stretch beyond the stop line until their vehicles are clear of each other.
TEST(Streets, ConnectionsBeginWhereTheMovementsDiverge) {
    const StreetSettings streets = two_streets();
    const LaneGraph graph = make_streets(streets);
    for (const Lane& this_lane : graph.lanes) {
        if (this_lane.origin < 0) continue;
        const Lane& origin = graph.lanes[at(this_lane.origin)];
        EXPECT_NEAR(this_lane.shape_start_m, origin.length_m - origin.stop_line_m, 1e-9) << this_lane.name;
        for (const int other : origin.next) {
            const Lane& beside = graph.lanes[at(other)];
            if (beside.name == this_lane.name) continue;
            EXPECT_GE(distance_m(beside.shape, pose_at(this_lane.shape, this_lane.shape_start_m).point),
                      streets.clearance_m - 0.01)
                << this_lane.name;
        }
        EXPECT_EQ(origin.next.size() > 1, this_lane.shape_start_m > 0.0) << this_lane.name;
    }
}

// With a passing clearance, the shared stretch is longer. It ends 1 m before the end of the shortest path at the
// latest.
TEST(Streets, ConnectionsBeginAtThePassingClearance) {
    for (const double radius_m : {20.0, 14.5}) {
        StreetSettings streets = two_streets();
        for (StreetIntersection& node : streets.intersections) node.radius_m = radius_m;
        streets.intersections[1].legs[0].exits = 3;
        const LaneGraph shorter = make_streets(streets);
        streets.passing_clearance_m = 3.5;
        const LaneGraph graph = make_streets(streets);
        check(graph);
        int checked = 0;
        for (const Lane& this_lane : graph.lanes) {
            if (this_lane.origin < 0) continue;
            const std::vector<int>& siblings = graph.lanes[at(this_lane.origin)].next;
            if (siblings.size() < 2) continue;
            EXPECT_GE(this_lane.shape_start_m, lane(shorter, this_lane.name).shape_start_m) << this_lane.name;
            EXPECT_GE(this_lane.length_m, 0.99) << this_lane.name;
            const bool is_cut = std::any_of(siblings.begin(), siblings.end(),
                                            [&](int other) { return graph.lanes[at(other)].length_m < 1.01; });
            for (const int other : siblings) {
                const Lane& beside = graph.lanes[at(other)];
                if (is_cut || beside.name == this_lane.name) continue;
                EXPECT_GE(distance_m(beside.shape, pose_at(this_lane.shape, this_lane.shape_start_m).point), 3.49)
                    << this_lane.name;
                ++checked;
            }
        }
        EXPECT_GE(checked, 8) << radius_m;
    }
}

// Turns are quarters of circles or ellipses. Each end of a turn lies on the centre line of a lane. The distance of this
// line from the axis of the street is half the median width, the widths of the lanes in between, and half a lane width.
TEST(Streets, TurnsLeadToTheNearestExitLane) {
    const LaneGraph graph = make_streets(two_streets());
    const Lane& left = lane(graph, "first_west_0_left");
    EXPECT_NEAR(left.shape.front().x_m, -20.0, 1e-9);
    EXPECT_NEAR(left.shape.front().y_m, -(2.0 + 1.75), 1e-9);
    EXPECT_NEAR(left.shape.back().x_m, 1.75, 1e-9);
    EXPECT_NEAR(left.shape.back().y_m, 20.0, 1e-9);
    EXPECT_EQ(graph.lanes[at(left.next[0])].name, "first_north_out_0");
    const Lane& right = lane(graph, "first_south_0_right");
    EXPECT_NEAR(right.shape.back().x_m, 20.0, 1e-9);
    EXPECT_NEAR(right.shape.back().y_m, -(2.0 + 2 * 3.5 + 1.75), 1e-9);  // the exit lane next to the kerb
    EXPECT_EQ(graph.lanes[at(right.next[0])].name, "second_west_in_2");
    EXPECT_EQ(graph.lanes[at(lane(graph, "first_north_0_left").next[0])].name, "second_west_in_0");
    EXPECT_EQ(graph.lanes[at(lane(graph, "first_west_1_straight").next[0])].name, "second_west_in_1");
    EXPECT_EQ(left.limit_mps, 7.0);
}

TEST(Streets, SuccessiveLanesJoin) {
    StreetSettings streets = streets_with_pockets();
    streets.intersections[1].y_m = 0.8;  // slightly off the straight line
    const LaneGraph graph = make_streets(streets);
    for (const Lane& this_lane : graph.lanes) {
        for (const int next : this_lane.next) {
            const Lane& other = graph.lanes[at(next)];
            const Point end = this_lane.shape.back();
            EXPECT_NEAR(std::hypot(end.x_m - other.shape.front().x_m, end.y_m - other.shape.front().y_m), 0.0, 1e-9)
                << this_lane.name << " to " << other.name;
        }
    }
    EXPECT_NEAR(lane(graph, "second_west_in_1").stop_line_m, std::hypot(160.0, 0.8), 1e-9);
}

TEST(Streets, PocketsLieInTheMedianAndEndAtTheCommonStopLine) {
    const LaneGraph graph = make_streets(streets_with_pockets());
    check(graph);
    const int pocket = find(graph, "first_east_in_0");
    const Lane& pocket_lane = graph.lanes[at(pocket)];
    EXPECT_EQ(pocket_lane.stop_line_m, 60.0);
    EXPECT_NEAR(pocket_lane.start_offset_m, 160.0 - 60.0, 1e-9);
    EXPECT_NEAR(pocket_lane.shape.front().x_m, 80.0, 1e-9);
    EXPECT_NEAR(pocket_lane.shape.back().x_m, 20.0, 1e-9);
    // Half the median minus half a lane width. The lane leads west, so it lies on the north side of the street.
    EXPECT_NEAR(pocket_lane.shape.back().y_m, 2.0 - 1.75, 1e-9);
    const auto listed = [&](const std::vector<int>& lanes) {
        return std::find(lanes.begin(), lanes.end(), pocket) != lanes.end();
    };
    EXPECT_FALSE(listed(graph.entries) || listed(graph.links));
    EXPECT_TRUE(
        std::any_of(graph.routes.begin(), graph.routes.end(), [&](const Route& r) { return r.lanes[0] == pocket; }));
    for (const Lane& this_lane : graph.lanes) {
        EXPECT_EQ(std::find(this_lane.next.begin(), this_lane.next.end(), pocket), this_lane.next.end())
            << this_lane.name;
    }
    EXPECT_EQ(graph.lanes[at(lane(graph, "second_east_0_straight").next[0])].name, "first_east_in_1");
}

TEST(Streets, LanesOfAnApproachLinkToTheirNeighbours) {
    const LaneGraph graph = make_streets(streets_with_pockets());
    for (const Approach& approach : graph.approaches) {
        int left = -1;
        for (const int number : approach.lanes) {
            const Lane& this_lane = graph.lanes[at(number)];
            EXPECT_EQ(this_lane.left, left) << this_lane.name;
            if (left >= 0) {
                EXPECT_EQ(graph.lanes[at(left)].right, number);
            }
            EXPECT_EQ(graph.approaches[at(this_lane.approach)].name, approach.name);
            EXPECT_NEAR(this_lane.start_offset_m + this_lane.stop_line_m,
                        graph.lanes[at(approach.lanes.back())].start_offset_m +
                            graph.lanes[at(approach.lanes.back())].stop_line_m,
                        1e-9);
            left = number;
        }
        EXPECT_EQ(graph.lanes[at(left)].right, -1);
    }
    for (const Lane& this_lane : graph.lanes)
        EXPECT_EQ(this_lane.approach >= 0, this_lane.signal_group >= 0) << this_lane.name;
}

// Oncoming straight traffic has priority, even if the left lane has its own signal group, because both signals can be
// green at the same time.
TEST(Streets, LeftTurnsYieldToOncomingTraffic) {
    for (const StreetSettings& streets : {two_streets(), streets_with_pockets()}) {
        const LaneGraph graph = make_streets(streets);
        const int left = find(graph, "first_west_0_left");
        int oncoming_conflicts = 0;
        for (const Conflict& conflict : graph.conflicts_of(left)) {
            const std::string& other = graph.lanes[at(conflict.other)].name;
            const bool oncoming = other.starts_with("first_east_") && other.ends_with("_straight");
            const bool minor = other.starts_with("first_south_") || other.starts_with("first_north_");
            oncoming_conflicts += oncoming ? 1 : 0;
            if (oncoming) {
                EXPECT_TRUE(conflict.yields) << other;
            }
            if (minor) {
                EXPECT_FALSE(conflict.yields || conflict.other_yields) << other;
            }
            EXPECT_TRUE(other.starts_with("first_")) << other;
        }
        EXPECT_EQ(oncoming_conflicts, 3);
    }
}

TEST(Streets, OnlyProtectedLanesHaveTheirOwnSignalGroup) {
    StreetSettings streets = streets_with_pockets();
    const auto group = [&](const std::string& name) { return lane(make_streets(streets), name).signal_group; };
    EXPECT_EQ(group("first_west_in_0"), 1);
    EXPECT_EQ(group("first_west_in_1"), 0);
    EXPECT_EQ(group("first_south_in_0"), 2);
    EXPECT_EQ(group("second_west_in_0"), 3);
    streets.intersections[0].programme = streets.intersections[1].programme;  // without a protected left turn
    EXPECT_EQ(group("first_west_in_0"), 0);
}

// If there are more exit lanes than straight lanes, the straight lanes lead to those exit lanes that give the smallest
// sum of lateral shifts. The lanes keep their order.
TEST(Streets, StraightLanesLeadToTheNearestExitLanes) {
    StreetSettings streets = two_streets();
    streets.intersections[0].legs[0].lanes = {{"left"}, {"straight"}, {"straight+right"}};
    const LaneGraph graph = make_streets(streets);
    EXPECT_EQ(graph.lanes[at(lane(graph, "first_west_1_straight").next[0])].name, "second_west_in_1");
    EXPECT_EQ(graph.lanes[at(lane(graph, "first_west_2_straight").next[0])].name, "second_west_in_2");
}

TEST(Streets, PedestrianLightsHaveTwoLegs) {
    StreetSettings streets = two_streets();
    streets.intersections[1] = street_node("light", 150.0, false);
    streets.intersections[1].radius_m = 5.0;
    const LaneGraph graph = make_streets(streets);
    check(graph);
    EXPECT_NEAR(lane(graph, "light_west_1_straight").length_m, 10.0, 1e-9);
    EXPECT_NEAR(lane(graph, "light_west_in_1").stop_line_m, 125.0, 1e-9);
}

TEST(Streets, RefuseInvalidSettings) {
    StreetSettings streets = two_streets();
    streets.intersections[1].name = "first";
    EXPECT_THROW(make_streets(streets), InputError);
}

}  // namespace
}  // namespace stopline
