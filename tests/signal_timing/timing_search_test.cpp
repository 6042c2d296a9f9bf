// Tests of the search over greens and offsets.
#include "signal_timing/timing_search.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "signal_timing/timing_scenario.h"

namespace stopline {
namespace {

TEST(TimingSearch, GreensLieAroundTheStartValue) {
    EXPECT_EQ(searched_greens_s(20.0, 5.0, 5, 1.6), (std::vector<double>{13, 16, 20, 25, 32}));
    EXPECT_EQ(searched_greens_s(20.0, 15.0, 5, 1.6), (std::vector<double>{16, 20, 25, 32}));
    EXPECT_EQ(searched_greens_s(20.0, 5.0, 1, 1.6), (std::vector<double>{20}));
    EXPECT_EQ(searched_greens_s(20.0, 5.0, 3, 2.0), (std::vector<double>{10, 20, 40}));
    EXPECT_EQ(searched_greens_s(2.0, 1.0, 5, 1.6), (std::vector<double>{1, 2, 3}));
}

TEST(TimingSearch, OffsetsCoverTheCycle) {
    EXPECT_EQ(searched_offsets_s(14.0, 60.0, 4), (std::vector<double>{0, 14, 15, 30, 45}));
    EXPECT_EQ(searched_offsets_s(14.0, 60.0, 1), (std::vector<double>{14}));
}

PopulationTiming start_of(double green_s, double cross_green_s) {
    PopulationTiming start;
    start.saturation.population = "CTG-Ref";
    start.times.green_s = {green_s, cross_green_s};
    return start;
}

constexpr const char* kTable =
    "point,green_s,cross_green_s,population,seed,delay_s,throughput_veh_h\n"
    "0,20,20,CTG-Ref,1,15,3600\n"
    "1,20,20,CTG-Ref,2,17,3620\n"
    "2,30,20,CTG-Ref,1,12,3500\n"
    "3,30,20,CTG-Ref,2,13,3500\n"
    "4,30,30,CTG-Ref,1,20,3610\n"
    "5,30,30,CTG-Ref,2,20,3630\n";

TEST(TimingSearch, FindsTheBestSetting) {
    const Scenario scenario = timed_intersection();
    const TimingSearch delay = search_results(scenario, kTable, start_of(20.0, 20.0), Objective::delay);
    ASSERT_EQ(delay.all.size(), 3U);
    EXPECT_EQ(delay.start, 0U);
    EXPECT_EQ(delay.best, (std::vector<std::size_t>{1, 0, 2}));
    EXPECT_EQ(delay.all[1].cycle_s, 66.0);
    const MeanInterval difference = difference_to_start(delay, 1);  // -3 and -4
    EXPECT_NEAR(difference.mean, -3.5, 1e-12);
    EXPECT_NEAR(difference.interval.high - difference.interval.low, 2.0 * 12.7062 * 0.5, 1e-3);
    const TimingSearch throughput = search_results(scenario, kTable, start_of(20.0, 20.0), Objective::throughput);
    EXPECT_EQ(throughput.best, (std::vector<std::size_t>{2, 0, 1}));
    // The best setting has the longest green, and the shortest cross green.
    EXPECT_TRUE(is_best_at_border(delay, {5.0, 5.0}));
    TimingSearch inner = delay;
    inner.all.push_back({{{40.0, 15.0}, 0.0}, 71.0, {30.0, 30.0}, {3500.0, 3500.0}});
    EXPECT_FALSE(is_best_at_border(inner, {5.0, 5.0}));
    inner.best = {0};
    EXPECT_TRUE(is_best_at_border(inner, {5.0, 5.0}));
    EXPECT_FALSE(is_best_at_border(inner, {20.0, 5.0}));
}

TEST(TimingSearch, OneSeedHasNoInterval) {
    const MeanInterval one = mean_interval({4.0});
    EXPECT_EQ(one.mean, 4.0);
    EXPECT_TRUE(std::isnan(one.interval.low));
}

double metric(const std::vector<RunMetric>& metrics, const std::string& column) {
    for (const RunMetric& one : metrics) {
        if (one.column == column) return std::stod(one.value);
    }
    ADD_FAILURE() << "no metric " << column;
    return 0.0;
}

TEST(TimingSearch, FreeTrafficHasNoDelay) {
    const Scenario scenario = timed_intersection({"fidelity=meso", "meso=passages", "signal.green=3600 s",
                                                  "demand.inflow=200 veh/h", "demand.approaches=[west_in, east_in]"});
    const std::vector<RunMetric> metrics = timing_metrics(scenario, 0, {});
    EXPECT_NEAR(metric(metrics, "throughput_veh_h"), 400.0, 5.0);
    EXPECT_NEAR(metric(metrics, "delay_s"), 0.0, 0.1);
}

// The delay of evenly spaced arrivals is d1. It leaves out that a vehicle still accelerates beyond the stop line, which
// takes less than a third of the time from rest to the speed limit.
TEST(TimingSearch, MeasuredDelayIsTheUniformDelay) {
    Scenario scenario = timed_intersection({"fidelity=meso", "meso=passages"});
    const PopulationTiming timing = time_signals(scenario, {}).front();
    scenario.signal.green_s = timing.times.green_s[0];
    scenario.signal.cross_green_s = timing.times.green_s[1];
    const std::vector<RunMetric> metrics = timing_metrics(scenario, 0, {});
    EXPECT_NEAR(metric(metrics, "throughput_veh_h"), 3600.0, 60.0);
    EXPECT_GT(metric(metrics, "delay_s"), timing.lanes[0].uniform_delay_s);
    EXPECT_LT(metric(metrics, "delay_s"), timing.lanes[0].uniform_delay_s + 4.0);
    EXPECT_EQ(metric(metrics, "overlaps"), 0.0);
}

// Random arrivals add delay. They go on until the end of a run without duration, too.
TEST(TimingSearch, RandomArrivalsAddDelay) {
    const std::vector<std::string> overrides{"fidelity=meso", "meso=passages", "signal.green=19 s"};
    std::vector<std::string> random = overrides;
    random.emplace_back("demand.arrivals=poisson");
    const std::vector<RunMetric> even = timing_metrics(timed_intersection(overrides), 0, {});
    const std::vector<RunMetric> poisson = timing_metrics(timed_intersection(random), 0, {});
    EXPECT_NEAR(metric(poisson, "throughput_veh_h"), 3600.0, 200.0);
    EXPECT_GT(metric(poisson, "delay_s"), metric(even, "delay_s") + 0.5);
}

TEST(TimingSearch, CountsVehiclesThatWaitToEnter) {
    const std::vector<std::string> overrides{"fidelity=meso", "meso=passages", "duration=600 s"};
    std::vector<std::string> heavy = overrides;
    heavy.emplace_back("demand.inflow=6000 veh/h");
    heavy.emplace_back("network.intersection.approach_length=60 m");
    const std::vector<RunMetric> metrics = timing_metrics(timed_intersection(heavy), 0, {});
    EXPECT_GT(metric(metrics, "backlog"), 500.0);
    EXPECT_GT(metric(metrics, "delay_s"), 200.0);
}

// One-way traffic from the west meets green at each intersection if the offset is the travel time between them.
TEST(TimingSearch, OffsetOfTravelTimeServesOneWayTraffic) {
    const auto delay_s = [](const std::string& offset) {
        return metric(
            timing_metrics(timed_intersection({"network.kind=grid", "network.grid.columns=4",
                                               "network.grid.column_spacing=192.5 m", "signal.green=19 s",
                                               "demand.approaches=[c0r0_west_in]", "fidelity=meso", "meso=passages",
                                               "duration=1200 s", "measure.window=300 s", "signal.offset=" + offset}),
                           0, {}),
            "delay_s");
    };
    const double progression_s = delay_s("14 s");  // 192.5 m at 50 km/h
    EXPECT_LT(progression_s, 0.6 * delay_s("0 s"));
    EXPECT_LT(progression_s, 0.6 * delay_s("40 s"));
}

TEST(TimingSearch, VariesTheTimesOfTheSignal) {
    const Scenario scenario =
        timed_intersection({"network.kind=grid", "network.grid.columns=2", "duration=600 s", "measure.window=300 s"});
    SearchOptions options;
    options.populations_in_file = {"CTG-Ref"};
    options.overrides = {"signal.green=9 s", "duration=600 s"};
    PopulationTiming start = start_of(20.0, 10.0);
    start.cycle_s = 46.0;
    start.times.offset_s = 14.0;
    const SweepSettings settings = search_settings(scenario, start, options, {});
    ASSERT_EQ(settings.axes.size(), 4U);
    EXPECT_EQ(settings.axes[2].paths, std::vector<std::string>{"signal.offset"});
    EXPECT_EQ(search_overrides(scenario, "CTG-Ref", options), std::vector<std::string>{"duration=600 s"});
    EXPECT_EQ(search_overrides(scenario, "CDG", options).back(), "measure.baseline=CDG");
}

}  // namespace
}  // namespace stopline
