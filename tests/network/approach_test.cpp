// Tests of make_approach(): parallel lanes up to a stop line, and an exit lane beyond each of them.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "network/lane_graph.h"

namespace stopline {
namespace {

ApproachSettings three_lanes() {
    ApproachSettings settings;
    settings.lanes = 3;
    settings.length_m = 420.0;
    settings.exit_length_m = 310.0;
    settings.speed_limit_mps = 12.5;
    settings.gradient = -0.03;
    return settings;
}

double length_of(const std::vector<Point>& shape) {
    double sum = 0.0;
    for (std::size_t k = 1; k < shape.size(); ++k) {
        sum += std::hypot(shape[k].x_m - shape[k - 1].x_m, shape[k].y_m - shape[k - 1].y_m);
    }
    return sum;
}

TEST(Approach, EntryAndExitLanesAlternate) {
    const LaneGraph graph = make_approach(three_lanes());
    ASSERT_EQ(graph.lanes.size(), 6u);
    ASSERT_EQ(graph.routes.size(), 3u);
    EXPECT_EQ(graph.signal_groups, 1);
    for (int k = 0; k < 3; ++k) {
        const auto lane = static_cast<std::size_t>(2 * k);
        EXPECT_EQ(graph.entries[static_cast<std::size_t>(k)], 2 * k);
        EXPECT_EQ(graph.routes[static_cast<std::size_t>(k)].lanes, (std::vector<int>{2 * k, 2 * k + 1}));
        EXPECT_EQ(graph.lanes[lane].next, std::vector<int>{2 * k + 1});
        EXPECT_TRUE(graph.lanes[lane + 1].next.empty());
        EXPECT_EQ(graph.lanes[lane].signal_group, 0);
        EXPECT_EQ(graph.lanes[lane + 1].signal_group, -1);
    }
}

TEST(Approach, LanesMatchTheSettingsAndTheirShapes) {
    const ApproachSettings settings = three_lanes();
    const LaneGraph graph = make_approach(settings);
    std::set<std::string> names;
    for (std::size_t k = 0; k < graph.lanes.size(); ++k) {
        const Lane& lane = graph.lanes[k];
        EXPECT_EQ(lane.length_m, k % 2 == 0 ? settings.length_m : settings.exit_length_m);
        EXPECT_EQ(lane.limit_mps, settings.speed_limit_mps);
        EXPECT_EQ(lane.gradient, settings.gradient);
        EXPECT_NEAR(length_of(lane.shape), lane.length_m, 1e-9);
        names.insert(lane.name);
    }
    EXPECT_EQ(names.size(), graph.lanes.size());
}

TEST(Approach, ShapesMeetAtTheStopLineSideBySide) {
    const LaneGraph graph = make_approach(three_lanes());
    for (std::size_t k = 0; k < graph.lanes.size(); k += 2) {
        const Point end = graph.lanes[k].shape.back();
        const Point begin = graph.lanes[k + 1].shape.front();
        EXPECT_EQ(end.x_m, 0.0);
        EXPECT_EQ(begin.x_m, 0.0);
        EXPECT_EQ(end.y_m, begin.y_m);
        // The first approach lane is the leftmost one. Each further approach lane lies one lane width to the right of
        // the previous approach lane.
        if (k >= 2) {
            EXPECT_NEAR(graph.lanes[k - 2].shape.back().y_m - end.y_m, 3.5, 0.5);
        }
    }
}

TEST(Approach, PassesTheCheck) {
    EXPECT_NO_THROW(check(make_approach(three_lanes())));
    EXPECT_NO_THROW(check(make_approach({})));
}

}  // namespace
}  // namespace stopline
