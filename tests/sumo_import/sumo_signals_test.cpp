// Tests of make_sumo_signals(): SUMO's phases become programmes of signal groups.
#include <gtest/gtest.h>

#include <string>

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
using testing::two_phases;

constexpr double kStep_s = 0.1;

// Returns the programmes of all signal groups.
std::vector<GroupProgramme> signals_of(const std::string& text) {
    const SumoFiles files;
    const SignalPlans plans =
        make_sumo_signals(make_sumo_network(read_sumo_net(files.write("my.net.xml", text)), 2.0), kStep_s);
    std::vector<GroupProgramme> programmes;
    for (int group = 0; group < plans.groups(); ++group) programmes.push_back(plans.programme(group));
    return programmes;
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

SumoNetwork network_of(const std::string& phases, const std::string& matrix_row_of_link_0) {
    const SumoFiles files;
    const std::string text = replaced(signal_net(phases), R"(index="0" response="1110")",
                                      R"(index="0" response=")" + matrix_row_of_link_0 + "\"");
    return make_sumo_network(read_sumo_net(files.write("my.net.xml", text)), 2.0);
}

int lane_named(const LaneGraph& graph, const std::string& name) {
    for (std::size_t k = 0; k < graph.lanes.size(); ++k) {
        if (graph.lanes[k].name == name) return static_cast<int>(k);
    }
    return -1;
}

// Returns which of the links 0 (from s_in) and 1 (from w_in) yields in each second of the cycle: 0, 1, - (none).
std::string yielding_links(const SumoNetwork& network, int seconds) {
    const int first = lane_named(network.graph, ":J_0_0");
    const int second = lane_named(network.graph, ":J_1_0");
    for (const PhasePriority& changing : make_sumo_phase_priorities(network, kStep_s)) {
        if (changing.first() != first || changing.second() != second) continue;
        std::string text;
        for (int k = 0; k < seconds; ++k) {
            const Priority priority = changing.at(to_ticks(k + 0.5, kStep_s));
            EXPECT_FALSE(priority.first_yields && priority.second_yields);
            text += priority.first_yields ? '0' : priority.second_yields ? '1' : '-';
        }
        return text;
    }
    return "constant";
}

TEST(SumoSignals, PriorityFollowsTheLettersOfThePhase) {
    // Link 0 yields in the first phase (letter g) and has priority in the third phase (letter G). The red of the second
    // phase and the yellow of the fourth phase do not change the right of way.
    const std::string phases =
        R"(<phase duration="3" state="gGGG"/><phase duration="2" state="rGGG"/><phase duration="4" state="GgGG"/>)"
        R"(<phase duration="1" state="yyyy"/>)";
    EXPECT_EQ(yielding_links(network_of(phases, "1110"), 10), "0000011111");
    EXPECT_EQ(yielding_links(network_of(phases, "0000"), 10), "0000011111");
    const std::string same_letters = R"(<phase duration="3" state="GGGG"/><phase duration="4" state="GgGG"/>)";
    EXPECT_EQ(yielding_links(network_of(same_letters, "1110"), 7), "0001111");
}

TEST(SumoSignals, PriorityIsConstantIfThePhasesAgree) {
    EXPECT_EQ(yielding_links(
                  network_of(R"(<phase duration="9" state="gGGG"/><phase duration="3" state="rrrr"/>)", "1110"), 12),
              "constant");
    EXPECT_TRUE(make_sumo_phase_priorities(network_of(two_phases(), "1110"), kStep_s).empty());
}

}  // namespace
}  // namespace stopline
