// Tests of the phases that intersections of streets get from the seven steps of their programmes.
#include "signals/street_phases.h"

#include <gtest/gtest.h>

#include "signals/signal_controller.h"
#include "support/streets.h"

namespace stopline {
namespace {

constexpr double kStep_s = 0.1;

StreetIntersection with_pockets() { return streets_with_pockets().intersections[0]; }

TEST(StreetPhases, TakeTheTimesOfTheSevenSteps) {
    const StreetIntersection node = with_pockets();
    const std::vector<PhaseSettings> phases = make_street_phases(node);
    ASSERT_EQ(phases.size(), 3u);
    EXPECT_EQ(phases[0].green_s, node.programme.major_green_s);
    EXPECT_EQ(phases[1].green_s, node.programme.protected_left_s);
    EXPECT_EQ(phases[2].green_s, node.programme.minor_green_s);
    for (const std::size_t k : {0u, 1u}) {
        EXPECT_EQ(phases[k].yellow_s, node.programme.major_yellow_s);
        EXPECT_EQ(phases[k].all_red_s, node.programme.major_clearance_s);
    }
    EXPECT_EQ(phases[2].yellow_s, node.programme.minor_yellow_s);
    EXPECT_EQ(phases[2].all_red_s, node.programme.minor_clearance_s);
    // The protected green of 3 s is shorter than the default minimum.
    EXPECT_EQ(phases[0].min_green_s, 5.0);
    EXPECT_EQ(phases[1].min_green_s, 3.0);
    for (const PhaseSettings& phase : phases) {
        EXPECT_EQ(phase.longest_green_s(), phase.green_s);
        EXPECT_EQ(phase.recall, "off");
    }
    EXPECT_EQ(phases[0].permissive_movements, std::vector<std::string>{"left"});
}

TEST(StreetPhases, LeaveOutTheProtectedLeftWithoutStepOrLane) {
    StreetIntersection no_step = with_pockets();
    no_step.programme.protected_left_s = 0.0;
    StreetIntersection no_lane = street_node("plain", 0.0);
    no_lane.programme.protected_left_s = 3.0;
    for (const StreetIntersection& node : {no_step, no_lane}) {
        const std::vector<PhaseSettings> phases = make_street_phases(node);
        ASSERT_EQ(phases.size(), 2u);
        EXPECT_EQ(phases[0].protected_movements, std::vector<std::string>{"major"});
        EXPECT_TRUE(phases[0].permissive_movements.empty());
        EXPECT_EQ(phases[1].protected_movements, std::vector<std::string>{"minor"});
    }
}

TEST(StreetPhases, ServePedestriansInEachCycle) {
    StreetIntersection node = street_node("pedestrians", 0.0, false);
    std::vector<PhaseSettings> phases = make_street_phases(node);
    ASSERT_EQ(phases.size(), 2u);
    EXPECT_EQ(phases[0].recall, "off");
    EXPECT_EQ(phases[1].recall, "maximum");
    node.programme.minor_green_s = 0.0;
    EXPECT_EQ(make_street_phases(node).size(), 1u);
}

TEST(StreetPhases, ThePlanProtectsEachGroupInOnePhase) {
    SignalSettings settings;
    settings.controller = "actuated";
    const SignalPlan plan = make_street_signal_plan(settings, with_pockets(), 6, kStep_s);
    EXPECT_STREQ(plan.controller->name, "actuated");
    EXPECT_EQ(plan.groups, (std::vector<int>{6, 7, 8}));
    ASSERT_EQ(plan.phases.phases.size(), 3u);
    ASSERT_EQ(plan.phases.rings.phases.size(), 3u);
    const std::array<std::uint64_t, 3> greens{0b011, 0b010, 0b100};
    const std::array<std::uint64_t, 3> protection{0b001, 0b010, 0b100};
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(plan.phases.phases[k].green_groups, greens[k]) << k;
        EXPECT_EQ(plan.phases.rings.phases[k].protected_groups, protection[k]) << k;
    }
    // The programme of the seven steps stays available to rules that need one.
    EXPECT_EQ(plan.programmes[0].cycle_ticks(), to_ticks(with_pockets().programme.cycle_s(), kStep_s));
}

}  // namespace
}  // namespace stopline
