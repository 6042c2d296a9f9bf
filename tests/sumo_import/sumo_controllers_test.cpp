// Tests of the import of SUMO's signals of the types `actuated` and `NEMA`.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "signals/signal_controller.h"
#include "sumo_import/controllers/sumo_controller.h"
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

SumoNetwork network_of(const std::string& text) {
    const SumoFiles files;
    return make_sumo_network(read_sumo_net(files.write("my.net.xml", text)), 2.0);
}

// Returns the network of signal_net() with a signal of this type.
std::string net_with(const std::string& type, const std::string& content) {
    return replaced(signal_net(content), "type=\"static\"", "type=\"" + type + "\"");
}

bool warns(const SumoNetwork& network, const std::string& part) {
    const std::vector<std::string> lines = network.net.warnings.lines();
    return std::any_of(lines.begin(), lines.end(),
                       [&](const std::string& line) { return line.find(part) != std::string::npos; });
}

std::string actuated_phases() {
    return R"(        <param key="max-gap" value="2.5"/>
        <param key="detector-gap" value="3"/>
        <phase duration="20" minDur="6" maxDur="45" state="rGGG"/>
        <phase duration="4" state="ryyy"/>
        <phase duration="1" state="rrrr"/>
        <phase duration="12" minDur="5" maxDur="30" state="Grrr"/>
        <phase duration="3" state="yrrr"/>
)";
}

TEST(SumoControllers, ActuatedSignalsBecomeControllers) {
    const SumoNetwork network = network_of(net_with("actuated", actuated_phases()));
    EXPECT_TRUE(network.net.warnings.lines().empty()) << network.net.warnings.lines().front();
    const SignalPlans plans = make_sumo_signals(network, kStep_s);
    ASSERT_EQ(plans.size(), 2U);
    const SignalPlan& plan = plans[1];
    EXPECT_STREQ(plan.controller->name, "actuated");
    ASSERT_EQ(plan.phases.phases.size(), 2U);
    const SignalPhase& first = plan.phases.phases[0];
    EXPECT_EQ(first.min_green_ticks, 60);
    EXPECT_EQ(first.max_green_ticks, 450);
    EXPECT_EQ(first.gap_ticks, 25);
    EXPECT_EQ(first.yellow_ticks, 40);
    EXPECT_EQ(first.all_red_ticks, 10);
    EXPECT_EQ(first.recall, Recall::minimum);
    EXPECT_EQ(plan.phases.phases[1].yellow_ticks, 30);
    EXPECT_EQ(plan.phases.phases[1].all_red_ticks, 0);
    EXPECT_EQ(first.green_groups ^ plan.phases.phases[1].green_groups, 0b11U) << "each link has green in one phase";
    // One detector for each of the three lanes: 3 s at 13.89 m/s, but at most the space for the minimum green.
    ASSERT_EQ(plan.lane_detectors.size(), 3U);
    for (const LaneDetector& detector : plan.lane_detectors) {
        const bool is_south = network.graph.lanes[static_cast<std::size_t>(detector.lane)].name.starts_with("s_in");
        EXPECT_EQ(detector.phases, is_south ? 0b10U : 0b01U);
        EXPECT_NEAR(detector.to_line_m, std::min(3.0 * 13.89, ((is_south ? 5.0 : 6.0) / 1.9 + 0.5) * 7.5), 1e-9);
    }
    EXPECT_TRUE(make_sumo_phase_priorities(network, kStep_s).empty());
}

TEST(SumoControllers, PhasesFollowNext) {
    std::string phases = actuated_phases();
    // Two more phases stand behind the others. The first red leads to them.
    phases = replaced(phases, "duration=\"1\" state", "duration=\"1\" next=\"5\" state");
    phases +=
        "        <phase duration=\"9\" minDur=\"4\" maxDur=\"10\" state=\"Grrr\" name=\"extra\"/>\n"
        "        <phase duration=\"3\" state=\"yrrr\" next=\"0\"/>\n";
    const SumoNetwork network = network_of(net_with("actuated", phases));
    const SignalPlans plans = make_sumo_signals(network, kStep_s);
    ASSERT_EQ(plans[1].phases.phases.size(), 2U);
    EXPECT_EQ(plans[1].phases.phases[1].min_green_ticks, 40);
    const SumoNetwork several = network_of(net_with("actuated", replaced(phases, "next=\"5\"", "next=\"5 3\"")));
    EXPECT_TRUE(warns(several, "'next' with several phases"));
}

TEST(SumoControllers, WhatIsNotSupportedIsNamed) {
    const SumoNetwork network =
        network_of(net_with("actuated", replaced(actuated_phases(), "<param key=\"max-gap\"",
                                                 "<param key=\"linkMaxDur:1\" value=\"3\"/><param key=\"max-gap\"")));
    EXPECT_TRUE(warns(network, "the parameter 'linkMaxDur:1' of signals of type 'actuated' is ignored"));
    // A link that loses green without yellow.
    const SumoNetwork abrupt = network_of(net_with("actuated", replaced(actuated_phases(), "\"ryyy\"", "\"ryrr\"")));
    EXPECT_TRUE(warns(abrupt, "the phases between two greens of the actuated signal 'J' are not yellow"));
    EXPECT_TRUE(warns(abrupt, "signals of type 'actuated' run as fixed-time signals"));
    EXPECT_TRUE(make_sumo_signals(abrupt, kStep_s)[1].controller->follows_programme);
    const SumoNetwork other = network_of(net_with("delay_based", actuated_phases()));
    EXPECT_TRUE(warns(other, "signals of type 'delay_based' run as fixed-time signals"));
    const SumoFiles files;
    EXPECT_EQ(testing::refusal([&] {
                  make_sumo_network(read_sumo_net(files.write(
                                        "my.net.xml", net_with("actuated", replaced(actuated_phases(), "value=\"2.5\"",
                                                                                    "value=\"long\"")))),
                                    2.0);
              }).find("my.net.xml:"),
              0U);
}

// Phase 1 is the left turn of w_in, phase 2 its straight movement, phase 4 the traffic from the south.
std::string nema_phases(const std::string& parameters) {
    return "        <param key=\"ring1\" value=\"1,2,0,4\"/>\n        <param key=\"ring2\" value=\"0,6,0,0\"/>\n"
           "        <param key=\"barrierPhases\" value=\"4,0\"/>\n        <param key=\"coordinatePhases\" value=\"2,6\"/>\n" +
           parameters +
           R"(        <phase duration="99" minDur="5" maxDur="15" vehext="1.5" yellow="3" red="2" name="1" state="rrrG"/>
        <phase duration="99" minDur="8" maxDur="30" vehext="2" yellow="4" red="1" name="2" state="rGgg"/>
        <phase duration="99" minDur="5" maxDur="20" vehext="2" yellow="3" red="2" name="4" state="Grrr"/>
        <phase duration="99" minDur="8" maxDur="50" vehext="2" yellow="4" red="1" name="6" state="rGGr"/>
)";
}

TEST(SumoControllers, NemaSignalsBecomeRings) {
    const SumoNetwork network = network_of(net_with(
        "NEMA", nema_phases("<param key=\"minRecall\" value=\"2,6\"/><param key=\"maxRecall\" value=\"4\"/>\n")));
    EXPECT_TRUE(network.net.warnings.lines().empty()) << network.net.warnings.lines().front();
    const SignalPlans plans = make_sumo_signals(network, kStep_s);
    const SignalPlan& plan = plans[1];
    EXPECT_STREQ(plan.controller->name, "dual_ring");
    ASSERT_EQ(plan.phases.phases.size(), 4U);
    const RingPlan& rings = plan.phases.rings;
    EXPECT_FALSE(rings.is_coordinated());
    EXPECT_EQ(rings.order[0][0], (std::vector<int>{0, 1}));
    EXPECT_EQ(rings.order[0][1], (std::vector<int>{2}));
    EXPECT_EQ(rings.order[1][0], (std::vector<int>{3}));
    EXPECT_TRUE(rings.order[1][1].empty());
    EXPECT_EQ(plan.phases.phases[0].recall, Recall::off);
    EXPECT_EQ(plan.phases.phases[1].recall, Recall::minimum);
    EXPECT_EQ(plan.phases.phases[2].recall, Recall::maximum);
    EXPECT_EQ(plan.phases.phases[0].gap_ticks, 15);
    EXPECT_EQ(plan.phases.phases[1].yellow_ticks, 40);
    EXPECT_EQ(plan.phases.phases[1].all_red_ticks, 10);
    EXPECT_EQ(plan.phases.phases[2].max_green_ticks, 200);
    // The left lane of w_in goes straight in phase 6 and left in phase 1, so both have its detector. Phase 2 has only a
    // minor green for it.
    for (const LaneDetector& detector : plan.lane_detectors) {
        EXPECT_EQ(detector.to_line_m, 20.0);
        EXPECT_EQ(detector.length_m, 20.0);
        const std::string& name = network.graph.lanes[static_cast<std::size_t>(detector.lane)].name;
        EXPECT_EQ(detector.phases, name == "w_in_1" ? 0b1001U : name == "w_in_0" ? 0b1010U : 0b0100U) << name;
    }
}

TEST(SumoControllers, CoordinatedNemaSignalsHaveACycle) {
    const std::string coordination =
        "<param key=\"coordinate-mode\" value=\"true\"/><param key=\"total-cycle-length\" value=\"80\"/>\n";
    std::string text = net_with("NEMA", nema_phases(coordination));
    // Ring 1 takes 20 s + 35 s + 25 s, and ring 2 takes 55 s before the barrier.
    const SumoNetwork network = network_of(replaced(text, "offset=\"0\"", "offset=\"7\""));
    const SignalPlans plans = make_sumo_signals(network, kStep_s);
    const RingPlan& rings = plans[1].phases.rings;
    ASSERT_TRUE(rings.is_coordinated());
    EXPECT_EQ(rings.cycle_ticks, 800);
    EXPECT_EQ(rings.coordinated, (std::array<int, kRings>{1, 3}));
    EXPECT_EQ(rings.ticks_to(rings.phases[1].force_off, 70), 800 - 50) << "the clearance ends at the offset";
    const SumoNetwork wrong = network_of(replaced(text, "value=\"80\"", "value=\"90\""));
    EXPECT_TRUE(warns(wrong, "the rings of the signal 'J' are not supported: cycle: 90 s is not the sum"));
}

}  // namespace
}  // namespace stopline
