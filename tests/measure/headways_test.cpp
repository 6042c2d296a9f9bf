#include "measure/headways.h"

#include <gtest/gtest.h>

#include <cmath>

namespace stopline {
namespace {

// Returns two approach lanes (0 and 2) that end at a stop line, each with an exit lane (1 and 3).
LaneGraph two_lanes() {
    ApproachSettings settings;
    settings.lanes = 2;
    return make_approach(settings);
}

Passage passage(double time_s, int vehicle, int from_lane, int to_lane, float speed_mps = 10.0F) {
    return {time_s, vehicle, 0, from_lane, to_lane, speed_mps};
}

TEST(LinePassages, KeepStopLinesOnlyAndStartAtTheGreen) {
    const std::vector<LinePassage> passages = line_passages(
        two_lanes(),
        {passage(5.0, 0, -1, 0), passage(99.0, 7, 0, 1), passage(101.5, 0, 0, 1), passage(130.0, 0, 1, -1)}, 100.0);
    ASSERT_EQ(passages.size(), 1U);
    EXPECT_DOUBLE_EQ(passages[0].time_s, 1.5);
    EXPECT_EQ(passages[0].vehicle, 0);
    EXPECT_EQ(passages[0].position, 1);
    EXPECT_TRUE(std::isnan(passages[0].headway_s));
}

TEST(LinePassages, HaveHeadwaysAndPositionsPerLane) {
    const std::vector<LinePassage> passages = line_passages(
        two_lanes(), {passage(1.0, 0, 0, 1), passage(1.2, 1, 2, 3), passage(2.9, 3, 2, 3), passage(3.0, 2, 0, 1)}, 0.0);
    ASSERT_EQ(passages.size(), 4U);
    EXPECT_EQ(passages[1].lane, 0);
    EXPECT_EQ(passages[1].position, 2);
    EXPECT_DOUBLE_EQ(passages[1].headway_s, 2.0);
    EXPECT_TRUE(std::isnan(passages[2].headway_s));  // the first passage on the other lane
    EXPECT_EQ(passages[2].position, 1);
    EXPECT_NEAR(passages[3].headway_s, 1.7, 1e-12);
}

TEST(LinePassages, EndWithTheGreen) {
    const std::vector<LinePassage> passages =
        line_passages(two_lanes(), {passage(1.0, 0, 0, 1), passage(3.0, 1, 0, 1), passage(3.1, 2, 0, 1)}, 0.0);
    EXPECT_EQ(within_green(passages, 3.0).size(), 2U);
}

TEST(LastPositionsFlow, IsTheMeanOverTheLastPositionsOfEachLane) {
    std::vector<Passage> passages;
    for (int k = 0; k < 4; ++k) passages.push_back(passage(k * 2.0, k, 0, 1, 10.0F));
    for (int k = 4; k < 7; ++k) passages.push_back(passage(6.0 + (k - 3) * 1.0, k, 0, 1, 14.0F));
    const LastPositionsFlow flow = last_positions_flow(line_passages(two_lanes(), passages, 0.0), 3);
    EXPECT_EQ(flow.vehicles, 3);
    EXPECT_DOUBLE_EQ(flow.headway_s, 1.0);
    EXPECT_DOUBLE_EQ(flow.speed_mps, 14.0);
}

TEST(LastPositionsFlow, IgnoresTheFirstVehicleWithoutHeadway) {
    const LastPositionsFlow flow =
        last_positions_flow(line_passages(two_lanes(), {passage(1.0, 0, 0, 1), passage(3.0, 1, 0, 1)}, 0.0), 10);
    EXPECT_EQ(flow.vehicles, 1);
    EXPECT_DOUBLE_EQ(flow.headway_s, 2.0);
    EXPECT_EQ(last_positions_flow({}, 10).vehicles, 0);
    EXPECT_TRUE(std::isnan(last_positions_flow({}, 10).headway_s));
}

TEST(Mean, OfNothingIsNan) {
    EXPECT_TRUE(std::isnan(mean({})));
    const std::vector<double> values{1.0, 2.0, 6.0};
    EXPECT_DOUBLE_EQ(mean(values), 3.0);
}

}  // namespace
}  // namespace stopline
