// The verdict on runs that break down: gridlocks round a block, and networks in which nobody moves any more.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "experiment/network_run.h"
#include "scenario/load_scenario.h"

namespace stopline {
namespace {

NetworkFigures small_grid(std::vector<std::string> overrides) {
    overrides.insert(overrides.begin(), {"network.grid.columns=3", "network.grid.rows=3", "signal.green=20 s"});
    return run_network(load_scenario(STOPLINE_SOURCE_DIR "/scenarios/grid.yaml", overrides), 2);
}

// Streets round a block, each kept out of the next, have green one after the other.
TEST(Stability, AGridlockRoundABlockIsSeenWhateverLightIsGreen) {
    const double cycle_s = 2.0 * (20.0 + 8.0);
    const NetworkFigures figures =
        small_grid({"rules={keep_clear: on}", "duration=1500 s", "measure={outside: 20 m, steady: 600 s}"});
    ASSERT_FALSE(figures.hindrance.gridlocks.empty());
    const Gridlock& ring = figures.hindrance.gridlocks[0];
    EXPECT_GT(ring.to_s - ring.from_s, 10.0 * cycle_s);
    EXPECT_GE(ring.to_s, 1490.0) << "to the end";
    for (const Gridlock& gridlock : figures.hindrance.gridlocks) EXPECT_GE(gridlock.vehicles.size(), 3u);
    EXPECT_EQ(figures.stability, Stability::unstable);
}

// Without rules all stand before the flow has settled: there is no level from which it could fall.
TEST(Stability, ANetworkInWhichNobodyMovesIsUnstable) {
    const NetworkFigures figures =
        small_grid({"rules={}", "duration=1500 s", "measure={outside: 20 m, steady: 300 s}"});
    EXPECT_EQ(figures.steady.left, 0);
    EXPECT_EQ(figures.stability, Stability::unstable);
}

TEST(Stability, ARunWithoutHindranceIsStable) {
    const NetworkFigures figures = small_grid({"signal.green=5 s", "demand.left=0 %", "demand.right=0 %",
                                               "duration=1500 s", "measure={outside: 20 m, steady: 600 s}"});
    EXPECT_TRUE(figures.hindrance.gridlocks.empty());
    EXPECT_EQ(figures.stability, Stability::stable);
}

}  // namespace
}  // namespace stopline
