#include "measure/headways.h"

#include <gtest/gtest.h>

#include <cmath>

namespace stopline {
namespace {

// Two lanes with a stop line at their end (0 and 2), each with a road behind it (1 and 3).
LaneGraph two_lanes() {
    ApproachSettings settings;
    settings.lanes = 2;
    return make_approach(settings);
}

Passage front(double time_s, int vehicle, int from_lane, int to_lane, float speed_mps = 10.0F) {
    return {time_s, vehicle, 0, from_lane, to_lane, speed_mps};
}

TEST(LinePassages, KeepStopLinesOnlyAndCountFromTheGreen) {
    const std::vector<LinePassage> line = line_passages(
        two_lanes(), {front(5.0, 0, -1, 0), front(99.0, 7, 0, 1), front(101.5, 0, 0, 1), front(130.0, 0, 1, -1)},
        100.0);
    ASSERT_EQ(line.size(), 1U);
    EXPECT_DOUBLE_EQ(line[0].time_s, 1.5);
    EXPECT_EQ(line[0].vehicle, 0);
    EXPECT_EQ(line[0].position, 1);
    EXPECT_TRUE(std::isnan(line[0].headway_s));
}

TEST(LinePassages, HaveHeadwaysAndPositionsOfTheirOwnLane) {
    const std::vector<LinePassage> line = line_passages(
        two_lanes(), {front(1.0, 0, 0, 1), front(1.2, 1, 2, 3), front(2.9, 3, 2, 3), front(3.0, 2, 0, 1)}, 0.0);
    ASSERT_EQ(line.size(), 4U);
    EXPECT_EQ(line[1].lane, 0);
    EXPECT_EQ(line[1].position, 2);
    EXPECT_DOUBLE_EQ(line[1].headway_s, 2.0);
    EXPECT_TRUE(std::isnan(line[2].headway_s));  // the first of the other lane
    EXPECT_EQ(line[2].position, 1);
    EXPECT_NEAR(line[3].headway_s, 1.7, 1e-12);
}

TEST(LinePassages, WithinTheGreenEndWithIt) {
    const std::vector<LinePassage> line =
        line_passages(two_lanes(), {front(1.0, 0, 0, 1), front(3.0, 1, 0, 1), front(3.1, 2, 0, 1)}, 0.0);
    EXPECT_EQ(within_green(line, 3.0).size(), 2U);
}

TEST(LateFlow, IsTheMeanOverTheLastPositionsOfEachLane) {
    std::vector<Passage> passages;
    for (int k = 0; k < 4; ++k) passages.push_back(front(k * 2.0, k, 0, 1, 10.0F));
    for (int k = 4; k < 7; ++k) passages.push_back(front(6.0 + (k - 3) * 1.0, k, 0, 1, 14.0F));
    const LateFlow flow = late_flow(line_passages(two_lanes(), passages, 0.0), 3);
    EXPECT_EQ(flow.vehicles, 3);
    EXPECT_DOUBLE_EQ(flow.headway_s, 1.0);
    EXPECT_DOUBLE_EQ(flow.speed_mps, 14.0);
}

TEST(LateFlow, LeavesOutTheFirstWhichHasNoHeadway) {
    const LateFlow flow = late_flow(line_passages(two_lanes(), {front(1.0, 0, 0, 1), front(3.0, 1, 0, 1)}, 0.0), 10);
    EXPECT_EQ(flow.vehicles, 1);
    EXPECT_DOUBLE_EQ(flow.headway_s, 2.0);
    EXPECT_EQ(late_flow({}, 10).vehicles, 0);
    EXPECT_TRUE(std::isnan(late_flow({}, 10).headway_s));
}

TEST(Mean, OfNothingIsNoNumber) {
    EXPECT_TRUE(std::isnan(mean({})));
    const std::vector<double> values{1.0, 2.0, 6.0};
    EXPECT_DOUBLE_EQ(mean(values), 3.0);
}

}  // namespace
}  // namespace stopline
