// Tests of time-space diagrams of a street: the lane that a diagram follows, positions of stop lines, red phases, and
// vehicles in a green wave.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "figures/time_space_figure.h"
#include "runs/network/network_run.h"
#include "scenario/load_scenario.h"
#include "scenario/scenario_text.h"

namespace stopline {
namespace {

StreetTrace trace_of(const std::vector<std::string>& overrides) {
    std::vector<std::string> settings{"duration=400 s", "measure.window=200 s", "measure.time_space=184 s"};
    settings.insert(settings.end(), overrides.begin(), overrides.end());
    return run_network(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/arterial.yaml", settings), 2).street_trace;
}

TEST(TimeSpace, ShowsStopLinesAndRedPhasesOfEachIntersection) {
    const StreetTrace trace = trace_of({"signal.green=20 s", "signal.cross_green=10 s"});  // cycle 46 s, red 23 s
    std::map<double, double> red_s;
    for (const RedPhase& red : trace.reds) red_s[red.stop_line_m] += red.to_s - red.from_s;
    ASSERT_EQ(red_s.size(), 5u);
    double line_m = 155.0;
    for (const auto& [position_m, sum_s] : red_s) {
        EXPECT_NEAR(position_m, line_m, 5.0);  // connections can make the path longer than a straight line
        EXPECT_NEAR(sum_s, 4 * 23.0, 4.0);
        line_m = position_m + 192.5;
    }
}

TEST(TimeSpace, VehiclesPassAGreenWaveWithoutStopping) {
    const StreetTrace trace = trace_of({"signal.green=10 s", "signal.cross_green=10 s", "signal.offset=15 s",
                                        "demand.cross_left=0 %", "demand.cross_right=0 %"});
    std::map<int, const StreetPoint*> last_points;
    std::map<int, double> first_s;
    std::set<int> finished;
    for (const StreetPoint& point : trace.points) {
        const StreetPoint*& last = last_points[point.vehicle];
        if (last != nullptr) {
            ASSERT_GE(point.position_m, last->position_m);
            ASSERT_LE(point.position_m, last->position_m + 15.0 * (point.time_s - last->time_s));
        }
        last = &point;
        if (point.position_m > 160.0) first_s.try_emplace(point.vehicle, point.time_s);
        // Four street blocks take 15 s each without a stop.
        if (point.position_m > 930.0 && first_s.contains(point.vehicle) && first_s[point.vehicle] > 217.0) {
            EXPECT_LT(point.time_s - first_s[point.vehicle], 75.0);
            finished.insert(point.vehicle);
        }
    }
    EXPECT_GT(finished.size(), 20u);
}

// The trace of a street before the first step, and the gnuplot text of its diagram, which contains the title.
struct TracedStreet {
    StreetTrace trace;
    std::string title;
};

TracedStreet traced(const std::string& file, std::vector<std::string> overrides) {
    overrides.insert(overrides.begin(), {"duration=60 s", "measure.window=60 s", "measure.time_space=60 s"});
    const Scenario scenario = load_scenario(shipped("scenarios/" + file), overrides);
    const Model model = network_model(scenario, 0);
    TracedStreet result{StreetTracer(scenario, model).trace(), ""};
    result.title = time_space_figure(scenario, {"CDG"}, {result.trace}).body;
    return result;
}

TEST(TimeSpace, FollowsTheLaneThatLeadsStraightThroughTheStreet) {
    const std::vector<std::string> no_turns{"demand.cross_left=0 %", "demand.cross_right=0 %"};
    const auto with_lanes = [&](const std::string& lanes) {
        return traced("arterial.yaml", {"network.intersection.lanes=[" + lanes + "]",
                                        "network.intersection.radius=15 m", no_turns[0], no_turns[1]});
    };
    const TracedStreet complete = with_lanes("{movements: left}, {movements: straight}, {movements: right}");
    EXPECT_EQ(complete.trace.first_lane, "c0r0_west_in_1");
    EXPECT_TRUE(complete.trace.reaches_exit);
    EXPECT_GT(complete.trace.length_m, 1000.0);
    EXPECT_TRUE(
        contains(complete.title, "title 'Row r0 from west to east, straight on from lane c0r0\\_west\\_in\\_1' "));
    EXPECT_EQ(with_lanes("{movements: straight}, {movements: straight}, {movements: right}").trace.first_lane,
              "c0r0_west_in_1");
    EXPECT_EQ(traced("arterial.yaml", {}).trace.first_lane, "c0r0_west_in_1");
    const TracedStreet none = with_lanes("{movements: left}, {movements: right}");
    EXPECT_EQ(none.trace.first_lane, "c0r0_west_in_1");
    EXPECT_FALSE(none.trace.reaches_exit);
    EXPECT_TRUE(contains(none.title, "no lane goes straight through the whole street: this one ends at "));
}

TEST(TimeSpace, FollowsTheMiddleStreetFromEachSide) {
    const std::vector<std::string> sizes{"network.grid.columns=4", "network.grid.rows=3"};
    const auto from = [&](const std::string& side) {
        return traced("grid.yaml", {sizes[0], sizes[1], "measure.time_space_side=" + side});
    };
    EXPECT_EQ(from("west").trace.first_lane, "c0r1_west_in_1");
    EXPECT_EQ(from("east").trace.first_lane, "c3r1_east_in_1");
    EXPECT_EQ(from("south").trace.first_lane, "c2r0_south_in_1");
    EXPECT_EQ(from("north").trace.first_lane, "c2r2_north_in_1");
    EXPECT_TRUE(contains(from("east").title, "Row r1 from east to west, "));
    EXPECT_TRUE(contains(from("north").title, "Column c2 from north to south, "));
    EXPECT_TRUE(contains(from("north").title, "ylabel 'distance from the north end [m]'"));
    EXPECT_NEAR(from("east").trace.length_m, from("west").trace.length_m, 1e-6);
    EXPECT_LT(from("south").trace.length_m, from("west").trace.length_m - 100.0);
    EXPECT_EQ(traced("grid.yaml", {"network.grid.columns=1", "network.grid.rows=1", "measure.time_space_side=south"})
                  .trace.first_lane,
              "south_in_1");
}

TEST(TimeSpace, FollowsUserDefinedStreetsFromBothEnds) {
    const TracedStreet west = traced("berlin.yaml", {});
    EXPECT_TRUE(west.trace.reaches_exit);
    EXPECT_TRUE(contains(west.title, "Street from west to east, straight on from lane "));
    const TracedStreet east = traced("berlin.yaml", {"measure.time_space_side=east"});
    EXPECT_TRUE(east.trace.reaches_exit);
    EXPECT_EQ(west.trace.first_lane, "koenigin_elisabeth_str_west_in_3");
    EXPECT_EQ(east.trace.first_lane, "am_schillertheater_east_in_2");
    EXPECT_NEAR(east.trace.length_m, west.trace.length_m, 200.0);
}

// The offsets make a green wave toward the east. Westbound vehicles stop at the signals.
TEST(TimeSpace, GreenWaveHelpsOneDirectionOnly) {
    const auto stopped_share = [](const std::string& side) {
        const StreetTrace trace =
            trace_of({"signal.green=10 s", "signal.cross_green=10 s", "signal.offset=15 s", "demand.cross_left=0 %",
                      "demand.cross_right=0 %", "measure.time_space_side=" + side});
        std::map<int, const StreetPoint*> last_points;
        int stopped = 0;
        int samples = 0;
        for (const StreetPoint& point : trace.points) {
            const StreetPoint*& last = last_points[point.vehicle];
            if (last != nullptr && point.position_m > 200.0) {
                ++samples;
                stopped += point.position_m < last->position_m + 0.5 ? 1 : 0;
            }
            last = &point;
        }
        return static_cast<double>(stopped) / samples;
    };
    EXPECT_LT(stopped_share("west"), 0.001);
    EXPECT_GT(stopped_share("east"), 0.02);
}

}  // namespace
}  // namespace stopline
