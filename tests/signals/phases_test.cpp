// Tests of signal phases: lights over time, right of way of a phase, programmes by time of day, nominal cycle.
#include "signals/signal_phases.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace stopline {
namespace {

const std::vector<std::string> kMovements{"west_straight", "west_left", "south_straight"};
enum : std::size_t { kStraight, kLeft, kSouth };

PhaseSettings phase_of(std::vector<std::string> with_protected_green, std::vector<std::string> with_permissive_green,
                       double green_s, double yellow_s = 3.0, double all_red_s = 2.0) {
    PhaseSettings phase;
    phase.protected_movements = std::move(with_protected_green);
    phase.permissive_movements = std::move(with_permissive_green);
    phase.green_s = green_s;
    phase.yellow_s = yellow_s;
    phase.all_red_s = all_red_s;
    return phase;
}

// A protected left turn, then a permissive one beside the straight traffic, then pedestrians, then the cross street.
SignalSettings four_phases() {
    SignalSettings settings;
    settings.first_green_s = 10.0;
    settings.phases = {phase_of({"west_left"}, {}, 8.0), phase_of({"west_straight"}, {"west_left"}, 20.0),
                       phase_of({}, {}, 12.0, 0.0, 1.0), phase_of({"south_straight"}, {}, 15.0, 4.0, 1.0)};
    return settings;
}

// Returns the light of each second as a letter, from `from` to `to`, both in s.
std::string letters(const GroupProgramme& programme, int from, int to) {
    std::string text;
    for (int tick = from; tick < to; ++tick) {
        const Light light = programme.light(tick);
        text += light == Light::green ? 'G' : light == Light::yellow ? 'y' : 'r';
    }
    return text;
}

std::string repeated(char letter, int times) { return std::string(static_cast<std::size_t>(times), letter); }

PhaseTimelines timelines_of(const SignalSettings& settings, double end_s = 3600.0) {
    const PhasePlan plan = make_phase_plan(settings, kMovements, 1.0);
    return make_phase_timelines(plan, static_cast<int>(kMovements.size()), to_ticks(settings.first_green_s, 1.0),
                                to_ticks(end_s, 1.0));
}

TEST(Phases, ShowGreenYellowAndRedInTheirOrder) {
    const PhaseTimelines timelines = timelines_of(four_phases());
    const std::string red = repeated('r', 10);
    const std::string straight =
        repeated('r', 13) + repeated('G', 20) + "yyyrr" + repeated('r', 13) + repeated('r', 20);
    const std::string south = repeated('r', 13 + 25 + 13) + repeated('G', 15) + "yyyyr";
    EXPECT_EQ(letters(timelines.programmes[kStraight], 0, 152), red + straight + straight);
    EXPECT_EQ(letters(timelines.programmes[kSouth], 0, 152), red + south + south);
}

// The left turn has green in the first two phases. It keeps its green during yellow and red between them.
TEST(Phases, AMovementKeepsItsGreenIntoTheNextPhase) {
    const PhaseTimelines timelines = timelines_of(four_phases());
    const GroupProgramme& left = timelines.programmes[kLeft];
    const std::string cycle = repeated('G', 8 + 5 + 20) + "yyyrr" + repeated('r', 13 + 20);
    EXPECT_EQ(letters(left, 0, 152), repeated('r', 10) + cycle + cycle);
    EXPECT_EQ(left.next_change_tick(10), 10 + 33);
    EXPECT_EQ(left.next_change_tick(24), 10 + 33);
    EXPECT_EQ(left.light_start_tick(30), 10);
    EXPECT_EQ(left.first_tick(), 10);
}

TEST(Phases, AMovementWithGreenInAllPhasesHasNoChange) {
    SignalSettings settings;
    settings.first_green_s = 5.0;
    settings.phases = {phase_of({"west_straight", "west_left"}, {}, 10.0),
                       phase_of({"west_straight", "south_straight"}, {}, 20.0)};
    const PhaseTimelines timelines = timelines_of(settings);
    EXPECT_EQ(letters(timelines.programmes[kStraight], 0, 500), "rrrrr" + repeated('G', 495));
    EXPECT_EQ(timelines.programmes[kStraight].next_change_tick(7), std::numeric_limits<std::int64_t>::max());
    EXPECT_EQ(timelines.programmes[kStraight].next_change_tick(2), 5);
    EXPECT_EQ(phase_cycle(settings).longest_green_s, phase_cycle(settings).cycle_s);
}

TEST(Phases, ThePresentPhaseLastsUntilTheNextGreen) {
    const PhaseTimelines timelines = timelines_of(four_phases());
    EXPECT_EQ(timelines.phase.at(9), -1);
    const std::vector<int> begins{0, 13, 38, 51};
    for (int cycle = 0; cycle < 3; ++cycle) {
        for (std::size_t k = 0; k < begins.size(); ++k) {
            const int tick = 10 + 71 * cycle + begins[k];
            EXPECT_EQ(timelines.phase.at(tick), static_cast<int>(k));
            EXPECT_EQ(timelines.phase.start_tick(tick), tick);
            EXPECT_NE(timelines.phase.at(tick - 1), static_cast<int>(k));
        }
    }
}

TEST(Phases, NominalCycleIsTheSumOfThePhases) {
    const NominalCycle nominal = phase_cycle(four_phases());
    EXPECT_EQ(nominal.cycle_s, 71.0);
    EXPECT_EQ(nominal.longest_green_s, 33.0);  // the left turn
}

TEST(Phases, HaveSetsOfGroups) {
    const PhasePlan plan = make_phase_plan(four_phases(), kMovements, 0.1);
    ASSERT_EQ(plan.phases.size(), 4U);
    EXPECT_FALSE(plan.phases[0].has_green(kStraight));
    EXPECT_TRUE(plan.phases[0].has_green(kLeft));
    EXPECT_TRUE(plan.phases[1].has_green(kLeft));
    EXPECT_EQ(plan.phases[2].green_groups, 0U);
    EXPECT_EQ(plan.phases[3].yellow_ticks, 40);
}

TEST(Phases, MovementsWithEqualLightsShareAGroup) {
    SignalSettings settings = four_phases();
    settings.phases[1].permissive_movements.emplace_back("west_right");
    const std::vector<std::string> movements{"west_straight", "west_right", "west_left", "south_straight"};
    EXPECT_EQ(groups_with_equal_lights(settings, movements, false), (std::vector<int>{0, 0, 1, 2}));
    settings.phases[3].permissive_movements.emplace_back("west_right");
    EXPECT_EQ(groups_with_equal_lights(settings, movements, false), (std::vector<int>{0, 1, 2, 3}));
}

// The morning programme comes into force at 06:30, that is 100 s after the start of the run. It begins at the end of
// the cycle of the night programme that runs at this time.
TEST(Phases, AProgrammeBeginsAtTheEndOfACycle) {
    SignalSettings settings;
    settings.first_green_s = 0.0;
    settings.clock_s = 6.5 * 3600.0 - 100.0;
    settings.programmes = {
        {0.0, {phase_of({"west_straight"}, {}, 15.0), phase_of({"south_straight"}, {}, 10.0)}},
        {6.5 * 3600.0, {phase_of({"south_straight"}, {}, 30.0), phase_of({"west_straight"}, {"west_left"}, 40.0)}},
        {9.0 * 3600.0, {phase_of({"west_straight", "west_left"}, {}, 50.0), phase_of({"south_straight"}, {}, 5.0)}}};
    const PhaseTimelines timelines = timelines_of(settings, 3.0 * 3600.0);
    // Three night cycles of 35 s end at 105 s. The south keeps its green at the end, because the morning begins with
    // it.
    const std::string night = repeated('r', 20) + repeated('G', 10) + "yyyrr";
    const std::string last_night = repeated('r', 20) + repeated('G', 15);
    const std::string morning = repeated('G', 30) + "yyyrr" + repeated('r', 45);
    EXPECT_EQ(letters(timelines.programmes[kSouth], 0, 265), night + night + last_night + morning + morning);
    EXPECT_EQ(timelines.phase.at(104), 1);
    EXPECT_EQ(timelines.phase.at(105), 2);
    // The morning ends after 9,000 s, in the cycle that ends at 105 s + 113 x 80 s.
    EXPECT_EQ(timelines.phase.at(105 + 113 * 80 - 1), 3);
    EXPECT_EQ(timelines.phase.at(105 + 113 * 80), 4);
    EXPECT_EQ(phase_cycle(settings).cycle_s, 80.0);
    EXPECT_EQ(first_cycle_s(settings), 35.0);
}

TEST(Phases, TheLastProgrammeOfADayRunsUntilTheFirstOne) {
    SignalSettings settings;
    settings.programmes = {{6.0 * 3600.0, {phase_of({"west_straight"}, {}, 10.0)}},
                           {20.0 * 3600.0, {phase_of({"south_straight"}, {}, 20.0)}}};
    const PhasePlan plan = make_phase_plan(settings, kMovements, 1.0);
    EXPECT_EQ(plan.programme_at(0), 1);
    EXPECT_EQ(plan.programme_at(6 * 3600 - 1), 1);
    EXPECT_EQ(plan.programme_at(6 * 3600), 0);
    EXPECT_EQ(plan.programme_at(30 * 3600), 0);
    EXPECT_EQ(plan.next_programme_tick(21 * 3600), 30 * 3600);
}

}  // namespace
}  // namespace stopline
