// Tests of the start values of signals: demand of the lanes, measured saturation flow, and times.
#include "signal_timing/signal_timing.h"

#include <cmath>

#include <gtest/gtest.h>

#include "base/input_error.h"
#include "measure/signal_equations.h"
#include "scenario/build_model.h"
#include "signal_timing/timing_scenario.h"

namespace stopline {
namespace {

const LaneDemand& demand_of(const std::vector<LaneDemand>& demands, const std::string& lane) {
    for (const LaneDemand& one : demands) {
        if (one.lane == lane) return one;
    }
    throw InputError("no lane " + lane);
}

// Two lanes with 1,800 veh/h each, 2 s of start-up lost time and 1 s of end gain on both streets.
Saturation plain_saturation() {
    Saturation saturation;
    saturation.population = "CTG-Ref";
    for (int stage = 0; stage < kTimingStages; ++stage) {
        for (int index = 0; index < 2; ++index) saturation.lanes.push_back({stage, index, false, 1800.0, 2.0, 20.0});
    }
    saturation.lost.fill({2.0, 1.0});
    return saturation;
}

std::vector<LaneDemand> plain_demand(double west_east_veh_h, double south_north_veh_h) {
    std::vector<LaneDemand> demands;
    for (int index = 0; index < 2; ++index) {
        demands.push_back({"west_in_" + std::to_string(index), 0, index, west_east_veh_h});
        demands.push_back({"south_in_" + std::to_string(index), 1, index, south_north_veh_h});
    }
    return demands;
}

TEST(LaneDemands, SpreadTheInflowOverTheLanes) {
    const Scenario scenario = timed_intersection({"demand.left=20 %", "demand.right=10 %"});
    const std::vector<LaneDemand> demands = lane_demands(build_model(scenario, 0));
    ASSERT_EQ(demands.size(), 8U);
    for (const LaneDemand& one : demands) EXPECT_NEAR(one.flow_veh_h, 450.0, 1e-9) << one.lane;
    EXPECT_NEAR(demand_of(demands, "west_in_0").left_share, 0.2, 1e-12);
    EXPECT_NEAR(demand_of(demands, "west_in_1").right_share, 0.1, 1e-12);
    EXPECT_EQ(demand_of(demands, "north_in_0").stage, 1);
}

TEST(LaneDemands, OfAnArterialFollowTheRoutes) {
    const Scenario scenario = timed_intersection({"network.kind=grid", "network.grid.columns=2", "demand.left=20 %",
                                                  "demand.right=10 %", "duration=600 s", "measure.window=300 s"});
    const std::vector<LaneDemand> demands = lane_demands(build_model(scenario, 0));
    // The left lane of the link gets 80 % of the left lane from the west, and the left-turning 20 % from the north. The
    // right lane gets 90 % of the right lane from the west, and the right-turning 10 % from the south.
    EXPECT_NEAR(demand_of(demands, "c1r0_west_in_0").flow_veh_h, 450.0 * (0.8 + 0.2), 1e-6);
    EXPECT_NEAR(demand_of(demands, "c1r0_west_in_1").flow_veh_h, 450.0 * (0.9 + 0.1), 1e-6);
    EXPECT_NEAR(demand_of(demands, "c0r0_west_in_0").flow_veh_h, 450.0, 1e-9);
    const Scenario from_west =
        timed_intersection({"network.kind=grid", "network.grid.columns=2", "demand.left=20 %",
                            "demand.approaches=[c0r0_west_in]", "duration=600 s", "measure.window=300 s"});
    const std::vector<LaneDemand> along = lane_demands(build_model(from_west, 0));
    EXPECT_NEAR(demand_of(along, "c1r0_west_in_0").flow_veh_h, 450.0 * 0.8, 1e-6);
    EXPECT_NEAR(demand_of(along, "c1r0_south_in_0").flow_veh_h, 0.0, 1e-9);
}

TEST(SignalTiming, EqualFlowsGetEqualGreens) {
    const Scenario scenario = timed_intersection();
    const PopulationTiming timing = timing_of(scenario, plain_demand(450.0, 450.0), plain_saturation(), {});
    // Yellow 3 s and all red 5 s: L = 2 x (2 + 8 - 1) = 18 s, Y = 0.5, C = (27 + 5) / 0.5 = 64 s.
    EXPECT_NEAR(timing.webster_cycle_s, 64.0, 1e-9);
    // Effective green (64 - 18) / 2 = 23 s; displayed 23 + 2 - 1 = 24 s.
    EXPECT_EQ(timing.times.green_s[0], 24.0);
    EXPECT_EQ(timing.times.green_s[1], 24.0);
    EXPECT_EQ(timing.cycle_s, 64.0);
    double sum_s = timing.lost_time_s[0] + timing.lost_time_s[1];
    for (const StageLostTime& lost : timing.saturation.lost) sum_s += lost.effective_green_s(24.0);
    EXPECT_NEAR(sum_s, timing.cycle_s, 1e-9);
    ASSERT_EQ(timing.lanes.size(), 4U);
    for (const LaneTiming& lane : timing.lanes) {
        EXPECT_NEAR(lane.saturation, 450.0 / (1800.0 * 23.0 / 64.0), 1e-12);
        EXPECT_NEAR(lane.uniform_delay_s, uniform_delay_s(64.0, 23.0, lane.saturation), 1e-12);
    }
    EXPECT_EQ(timing.times.offset_s, 0.0);
}

TEST(SignalTiming, LongerGreenForTheHigherFlow) {
    const Scenario scenario = timed_intersection();
    const PopulationTiming timing = timing_of(scenario, plain_demand(720.0, 360.0), plain_saturation(), {});
    // Y = 0.6, C = 32 / 0.4 = 80 s; effective greens (80 - 18) x 2/3 and x 1/3.
    EXPECT_NEAR(timing.webster_cycle_s, 80.0, 1e-9);
    EXPECT_EQ(timing.times.green_s[0], std::round(62.0 * 2.0 / 3.0 + 1.0));
    EXPECT_EQ(timing.times.green_s[1], std::round(62.0 / 3.0 + 1.0));
    EXPECT_TRUE(timing.lanes[0].is_critical);
    EXPECT_FALSE(timing.lanes[1].is_critical);
}

TEST(SignalTiming, VarianceOfTheCapacityAddsToTheDelay) {
    const Scenario scenario = timed_intersection();
    Saturation saturation = plain_saturation();
    saturation.lanes[0].capacity_variance_ratio = 1.0;
    const PopulationTiming timing = timing_of(scenario, plain_demand(450.0, 450.0), saturation, {});
    const LaneTiming& varying = timing.lanes[0];
    const LaneTiming& constant = timing.lanes[1];
    EXPECT_DOUBLE_EQ(varying.uniform_delay_s, constant.uniform_delay_s);
    EXPECT_DOUBLE_EQ(varying.incremental_delay_s,
                     incremental_delay_s(varying.saturation, varying.capacity_veh_h, 0.25, 0.5, 2.0));
    EXPECT_GT(varying.incremental_delay_s, 1.5 * constant.incremental_delay_s);
}

TEST(SignalTiming, MinimumGreens) {
    const Scenario scenario = timed_intersection();
    TimingOptions options;
    options.min_green_s = 11.5;
    const PopulationTiming timing = timing_of(scenario, plain_demand(720.0, 18.0), plain_saturation(), options);
    EXPECT_EQ(timing.times.green_s[1], 12.0);
    options.pedestrians = true;
    // Four lanes of 3.5 m: 7 + 14 / 1.07 - 8 = 12.08 s.
    EXPECT_EQ(shortest_greens_s(scenario, options)[0], 13.0);
}

TEST(SignalTiming, DemandBeyondCapacityGivesFlowRatiosInsteadOfTimes) {
    const Scenario scenario = timed_intersection();
    const PopulationTiming timing = timing_of(scenario, plain_demand(1080.0, 720.0), plain_saturation(), {});
    EXPECT_TRUE(timing.is_oversaturated());
    EXPECT_TRUE(std::isnan(timing.cycle_s));
    EXPECT_NEAR(timing.flow_ratio_sum, 1.0, 1e-12);
    const std::string text = oversaturation_text(timing);
    EXPECT_NE(text.find("sum to 1.00"), std::string::npos) << text;
    EXPECT_NE(text.find("west-east: flow ratio 0.60 on lane west_in_0, 1080 of 1800 veh/h"), std::string::npos) << text;
    EXPECT_EQ(timing_csv(scenario, {timing}).find("nan"), std::string::npos);
}

TEST(SignalTiming, OptionsAndYamlApplyTheTimes) {
    Scenario scenario = timed_intersection();
    EXPECT_EQ(timing_overrides(scenario, {{24.0, 18.0}, 0.0}),
              (std::vector<std::string>{"signal.green=24 s", "signal.cross_green=18 s"}));
    const std::string yaml = timing_yaml(scenario, {{24.0, 18.0}, 0.0});
    const Scenario applied = parse_scenario(
        "{network: {kind: intersection}, demand: {kind: rate}, duration: 0 s, "
        "populations: [CDG]}\n",
        "plain.yaml", timing_overrides(scenario, {{24.0, 18.0}, 0.0}));
    EXPECT_EQ(applied.signal.green_s, 24.0);
    EXPECT_EQ(applied.signal.cross_green_s, 18.0);
    EXPECT_EQ(yaml, "signal:\n  first_green: 1 s\n  green: 24 s\n  cross_green: 18 s\n  yellow: 3 s\n  all_red: 5 s\n");
}

// At 30 km/h all vehicles from the fifth one on pass the stop line at nearly the speed limit.
TEST(Saturation, EqualsTheClosedFormOfTheSpacingPolicy) {
    const Scenario scenario =
        timed_intersection({"network.intersection.speed_limit=30 km/h", "demand.entry_speed=30 km/h"});
    const std::vector<LaneDemand> demands = lane_demands(build_model(scenario, 0));
    const Saturation saturation = measure_saturation(scenario, 0, {demands});
    EXPECT_FALSE(saturation.has_violations);
    const double speed_mps = 30.0 / 3.6;
    const double gap_m = 2.95 + 0.87 * speed_mps;  // CTG-Ref
    const double closed_veh_h = 3600.0 * speed_mps / (gap_m + scenario.vehicle.length_m);
    ASSERT_EQ(saturation.lanes.size(), 4U);
    for (const LaneSaturation& lane : saturation.lanes) {
        EXPECT_NEAR(lane.flow_veh_h / closed_veh_h, 1.0, 0.03) << lane.stage << " " << lane.index;
        EXPECT_GT(lane.startup_lost_time_s, 0.5);
    }
    // Vehicles per green x headway + lost time = green and changes.
    const double green_s = saturation.lost[0].effective_green_s(kSaturationGreen_s);
    EXPECT_NEAR(saturation.lanes[0].vehicles_per_green * 3600.0 / saturation.lanes[0].flow_veh_h, green_s, 0.05);
}

// With short greens, vehicles pass at lower speeds, and fewer of them pass at yellow.
TEST(Saturation, DependsOnTheGreen) {
    const Scenario scenario = timed_intersection({"populations=[CDG]", "fidelity=meso", "meso=passages"});
    SaturationInput input{lane_demands(build_model(scenario, 0))};
    const Saturation slow = measure_saturation(scenario, 0, input);
    input.greens_s = {10.0, 10.0};
    input.earlier = &slow;
    const Saturation brief = measure_saturation(scenario, 0, input);
    const double effective_s = brief.lost[0].effective_green_s(10.0);
    EXPECT_NEAR(brief.lanes[0].flow_veh_h * effective_s / 3600.0, brief.lanes[0].vehicles_per_green, 0.02);
    EXPECT_LT(brief.lost[0].end_gain_s, slow.lost[0].end_gain_s);
    // Four vehicles in a green are no saturated queue: headways are those of the earlier measurement.
    const Scenario sparse = timed_intersection({"fidelity=meso", "meso=passages"});
    SaturationInput few{lane_demands(build_model(sparse, 0))};
    const Saturation many = measure_saturation(sparse, 0, few);
    few.greens_s = {6.0, 6.0};
    few.earlier = &many;
    const Saturation measured = measure_saturation(sparse, 0, few);
    EXPECT_LT(measured.lanes[0].vehicles_per_green, 5.0);
    EXPECT_EQ(measured.lanes[0].flow_veh_h, many.lanes[0].flow_veh_h);
    EXPECT_NEAR(measured.lanes[0].flow_veh_h * measured.lost[0].effective_green_s(6.0) / 3600.0,
                measured.lanes[0].vehicles_per_green, 0.02);
}

TEST(Saturation, LeftTurnsLowerTheFlowOfTheirLane) {
    const Scenario scenario = timed_intersection({"demand.left=20 %", "fidelity=meso", "meso=passages"});
    const Saturation saturation = measure_saturation(scenario, 0, {lane_demands(build_model(scenario, 0))});
    EXPECT_TRUE(saturation.lanes[0].turns_left);
    EXPECT_FALSE(saturation.lanes[1].turns_left);
    EXPECT_LT(saturation.lanes[0].flow_veh_h, 0.9 * saturation.lanes[1].flow_veh_h);
    // The first left-turning vehicle of a queue blocks the vehicles behind it, at a random place in the queue.
    EXPECT_GT(saturation.lanes[0].capacity_variance_ratio, 0.2);
    EXPECT_EQ(saturation.lanes[1].capacity_variance_ratio, 0.0);
    // With less oncoming traffic, more vehicles turn.
    const Scenario quiet =
        timed_intersection({"demand.left=20 %", "demand.inflow=100 veh/h", "fidelity=meso", "meso=passages"});
    const Saturation freer = measure_saturation(quiet, 0, {lane_demands(build_model(quiet, 0))});
    EXPECT_GT(freer.lanes[0].flow_veh_h, 1.1 * saturation.lanes[0].flow_veh_h);
}

// The short gaps of CDG let many vehicles pass in a green. They must all have stood in the queue: otherwise their
// number and the headway of the queue do not fit together, and the lost time is below 0.
TEST(Saturation, QueuesOfDenseVehiclesOutlastTheGreen) {
    const Scenario scenario =
        timed_intersection({"demand.inflow=4700 veh/h", "fidelity=meso", "meso=passages", "populations=[CDG]"});
    SaturationInput input{lane_demands(build_model(scenario, 0))};
    for (const double green_s : {15.0, 40.0, 80.0}) {
        input.greens_s = {green_s, green_s};
        const Saturation saturation = measure_saturation(scenario, 0, input);
        for (const StageLostTime& lost : saturation.lost) {
            EXPECT_GT(lost.end_gain_s, 0.0) << green_s;
            EXPECT_LE(lost.end_gain_s, scenario.signal.yellow_s + 0.6) << green_s;
            EXPECT_GT(lost.total_s(scenario.signal.yellow_s, scenario.signal.all_red_s), 0.0) << green_s;
        }
    }
}

TEST(SignalTiming, CountsAProfileWithItsHighestFactor) {
    const Scenario scenario = timed_intersection(
        {"fidelity=meso", "meso=passages", "demand.profile=[{from: 0 s, inflow: 50 %}, {from: 300 s, inflow: 80 %}]"});
    const PopulationTiming timing = time_signals(scenario, {}).front();
    EXPECT_NEAR(timing.lanes[0].demand.flow_veh_h, 0.8 * 450.0, 1e-9);
}

// The run of the last measurement has the greens of the result, so the predicted capacity is the measured one.
TEST(SignalTiming, CapacityIsThatOfTheGreens) {
    const Scenario scenario = timed_intersection({"populations=[CTG-Ref, CDG]", "fidelity=meso", "meso=passages"});
    for (const PopulationTiming& timing : time_signals(scenario, {})) {
        EXPECT_TRUE(timing.greens_agree);
        SaturationInput input{lane_demands(build_model(scenario, 0)), timing.times.green_s, &timing.saturation};
        const std::size_t population = timing.saturation.population == "CDG" ? 1 : 0;
        const Saturation again = measure_saturation(scenario, population, input);
        const double measured_veh_h = again.lanes[0].vehicles_per_green * 3600.0 / timing.cycle_s;
        EXPECT_NEAR(timing.lanes[0].capacity_veh_h / measured_veh_h, 1.0, 0.12) << timing.saturation.population;
    }
}

TEST(SignalTiming, IsTheSameForAnyNumberOfThreads) {
    const Scenario scenario = timed_intersection({"populations=[CTG-Ref, CDG]", "fidelity=meso", "meso=passages"});
    TimingOptions options;
    const std::string one = timing_lanes_csv(time_signals(scenario, options));
    options.threads = 2;
    EXPECT_EQ(timing_lanes_csv(time_signals(scenario, options)), one);
}

TEST(SignalTiming, RefusesOtherScenarios) {
    const auto problem = [](const std::vector<std::string>& overrides) -> std::string {
        try {
            // The scenario is no file: the message names an override, and the file only if it has the field.
            check_timing_scenario(timed_intersection(overrides), "timed.yaml", overrides);
        } catch (const InputError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_EQ(problem({}), "");
    EXPECT_NE(problem({"demand={kind: saturated}"}).find("--set 'demand={kind: saturated}': field 'demand.kind'"),
              std::string::npos);
    EXPECT_NE(problem({"network={kind: approach}", "network.kind=approach", "duration=300 s"}).find("'network.kind'"),
              std::string::npos);
    EXPECT_NE(problem({"signal.phases=[{protected: [west_straight, east_straight], green: 20 s}, {protected: "
                       "[south_straight, north_straight], green: 20 s}]"})
                  .find("'signal.phases'"),
              std::string::npos);
}

}  // namespace
}  // namespace stopline
