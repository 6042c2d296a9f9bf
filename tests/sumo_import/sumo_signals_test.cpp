// Tests of make_sumo_signals(): SUMO's phases become programmes of signal groups.
#include <gtest/gtest.h>

#include "signals/programme.h"
#include "sumo_import/sumo_graph.h"
#include "sumo_import/sumo_net.h"
#include "sumo_import/sumo_signals.h"
#include "support/sumo_files.h"

namespace stopline {
namespace {

using testing::replaced;
using testing::signal_net;
using testing::SumoFiles;

constexpr double kStep_s = 0.1;

std::vector<GroupProgramme> signals_of(const std::string& text) {
    const SumoFiles files;
    return make_sumo_signals(make_sumo_network(read_sumo_net(files.write("my.net.xml", text)), 2.0), kStep_s);
}

Light light_at(const GroupProgramme& programme, double time_s) { return programme.light(to_ticks(time_s, kStep_s)); }

TEST(SumoSignals, FollowThePhases) {
    const auto signals = signals_of(signal_net(testing::two_phases()));
    ASSERT_EQ(signals.size(), 3U);  // always green, s_in, w_in
    EXPECT_EQ(light_at(signals[0], 12'345.0), Light::green);
    EXPECT_EQ(light_at(signals[1], 0.0), Light::red);
    EXPECT_EQ(light_at(signals[1], 24.0), Light::green);
    EXPECT_EQ(light_at(signals[1], 36.0), Light::yellow);
    EXPECT_EQ(light_at(signals[2], 0.0), Light::green);
    EXPECT_EQ(light_at(signals[2], 20.0), Light::yellow);
    EXPECT_EQ(light_at(signals[2], 24.0), Light::red);
    EXPECT_EQ(light_at(signals[2], 40.0), Light::green);
    EXPECT_EQ(signals[2].cycle_ticks(), 400);
}

TEST(SumoSignals, AreDelayedByTheOffset) {
    for (const char* const offset : {"offset=\"7\"", "offset=\"87\"", "offset=\"-33\""}) {
        const auto signals = signals_of(replaced(signal_net(testing::two_phases()), "offset=\"0\"", offset));
        EXPECT_EQ(light_at(signals[2], 0.0), Light::red) << offset;
        EXPECT_EQ(light_at(signals[2], 6.9), Light::red) << offset;
        EXPECT_EQ(light_at(signals[2], 7.0), Light::green) << offset;
        EXPECT_EQ(light_at(signals[2], 27.0), Light::yellow) << offset;
    }
}

TEST(SumoSignals, MergePhasesWithTheSameLight) {
    const auto signals =
        signals_of(signal_net("<phase duration=\"10.04\" state=\"GGGg\"/><phase duration=\"10.04\" "
                              "state=\"gGoO\"/><phase duration=\"10.04\" state=\"urrr\"/>"));
    EXPECT_EQ(signals[1].cycle_ticks(), 301);
    EXPECT_EQ(signals[1].light(200), Light::green);
    EXPECT_EQ(signals[1].light(201), Light::red);
    EXPECT_EQ(signals[1].light_start_tick(150), 0);
}

}  // namespace
}  // namespace stopline
