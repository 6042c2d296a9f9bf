// The stability of runs: gridlocks around a block, networks that come to rest, and stable traffic.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "runs/network/network_run.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

NetworkResult small_grid(std::vector<std::string> overrides) {
    overrides.insert(overrides.begin(), {"network.grid.columns=3", "network.grid.rows=3", "signal.green=20 s"});
    return run_network(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml", overrides), 2);
}

// Because of the keep-clear rule, vehicles on each street around a block wait for the queue on the next street of the
// block. The streets have green one after the other.
TEST(Stability, GridlockAroundABlockIsFoundDuringAnyGreen) {
    const double cycle_s = 2.0 * (20.0 + 8.0);
    const NetworkResult result = small_grid(
        {"rules={keep_clear: on}", "duration=1500 s", "measure={area_margin: 20 m, window: 600 s}", "seed=2"});
    // A gridlock can end by itself, so the first one need not be the one that lasts.
    const std::vector<Gridlock>& gridlocks = result.delays.gridlocks;
    const auto lasting = std::find_if(gridlocks.begin(), gridlocks.end(),
                                      [&](const Gridlock& g) { return g.to_s - g.from_s > 10.0 * cycle_s; });
    ASSERT_NE(lasting, gridlocks.end());
    EXPECT_GE(lasting->to_s, 1490.0) << "the gridlock lasts to the end";
    for (const Gridlock& gridlock : gridlocks) EXPECT_GE(gridlock.vehicles.size(), 3u);
    EXPECT_EQ(result.stability, Stability::unstable);
    EXPECT_NE(result.unstable_by, InstabilityCause::none);
    ASSERT_TRUE(result.collapse_s.has_value());
    EXPECT_LE(*result.collapse_s, lasting->from_s + 6.0 * cycle_s);
}

// Without traffic rules all vehicles stop before throughput reaches a steady state. The run counts as unstable,
// although there is no steady level from which throughput drops.
TEST(Stability, NetworkAtRestIsUnstable) {
    const NetworkResult result =
        small_grid({"rules={keep_clear: off}", "duration=1500 s", "measure={area_margin: 20 m, window: 300 s}"});
    EXPECT_EQ(result.measured.exited, 0);
    EXPECT_EQ(result.stability, Stability::unstable);
    EXPECT_TRUE(result.collapse_s.has_value());
}

// measure.interval only sets the resolution of the series, so it must not change the verdict on stability.
TEST(Stability, DoesNotDependOnTheInterval) {
    const std::vector<std::string> unstable_run{"rules={keep_clear: on}", "duration=2000 s"};
    std::vector<NetworkResult> runs;
    for (const char* const interval : {"10 s", "60 s", "300 s"}) {
        std::vector<std::string> settings = unstable_run;
        settings.push_back(std::string("measure={area_margin: 20 m, window: 900 s, interval: ") + interval + "}");
        runs.push_back(small_grid(settings));
    }
    EXPECT_EQ(runs[0].unstable_by, InstabilityCause::throughput_drop);
    EXPECT_LT(runs[0].collapse_s.value_or(1e9), 1500.0);
    for (const NetworkResult& run : runs) {
        EXPECT_EQ(run.stability, runs[0].stability);
        EXPECT_EQ(run.unstable_by, runs[0].unstable_by);
        EXPECT_EQ(run.collapse_s, runs[0].collapse_s);
    }
}

TEST(KeepClearRule, RecordsEachHoldOnce) {
    const std::vector<std::string> short_run{"duration=600 s", "measure={area_margin: 20 m, window: 300 s}"};
    std::vector<std::string> settings = short_run;
    settings.emplace_back("rules={keep_clear: on}");
    const NetworkResult result = small_grid(settings);
    ASSERT_FALSE(result.delays.rule_uses.empty());
    const RuleUse* previous = nullptr;
    for (const RuleUse& use : result.delays.rule_uses) {
        EXPECT_EQ(use.kind, RuleUse::Kind::keep_clear);
        EXPECT_GE(use.vehicle, 0);
        EXPECT_GE(use.blocker, 0);
        EXPECT_NE(use.vehicle, use.blocker);
        if (previous != nullptr && previous->vehicle == use.vehicle && previous->lane == use.lane) {
            EXPECT_GT(use.time_s - previous->time_s, 0.15) << "recorded in successive steps";
        }
        previous = &use;
    }
    settings.back() = "rules={keep_clear: off}";
    EXPECT_TRUE(small_grid(settings).delays.rule_uses.empty());
}

TEST(DelayLog, SeparatesDelayUpstreamOfTheArea) {
    const auto run = [](const char* margin) {
        return small_grid({"duration=900 s", std::string("measure={window: 300 s, area_margin: ") + margin + "}"});
    };
    const NetworkResult narrow = run("20 m");
    const NetworkResult wide = run("90 m");
    EXPECT_EQ(narrow.delays.delay_s, wide.delays.delay_s);
    double total_s = 0.0;
    for (std::size_t cause = 1; cause < kDelayCauseNames.size(); ++cause) total_s += narrow.delays.delay_s[cause];
    EXPECT_LT(narrow.delays.delay_upstream_s, total_s);
    EXPECT_LT(wide.delays.delay_upstream_s, 0.8 * narrow.delays.delay_upstream_s);
    EXPECT_GT(wide.delays.delay_upstream_s, 0.0) << "some queues reach back further";
}

TEST(Stability, FreelyFlowingTrafficIsStable) {
    const NetworkResult result = small_grid({"signal.green=5 s", "demand.left=0 %", "demand.right=0 %",
                                             "duration=1500 s", "measure={area_margin: 20 m, window: 600 s}"});
    EXPECT_TRUE(result.delays.gridlocks.empty());
    EXPECT_EQ(result.stability, Stability::stable);
}

}  // namespace
}  // namespace stopline
