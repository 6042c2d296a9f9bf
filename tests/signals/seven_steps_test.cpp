// Tests of the signal programmes with seven steps (Table 3 of the paper), tick by tick.
#include <gtest/gtest.h>

#include "signals/programme.h"

namespace stopline {
namespace {

constexpr double kStep_s = 0.1;
const SevenSteps kProtected{22, 3, 8, 3, 11, 3, 10};
const SevenSteps kPlain{24, 3, 9, 0, 12, 3, 9};
const SevenSteps kNoClearance{20, 0, 0, 5, 15, 0, 0};

// Returns the lights of the three signal groups (major street, its left turns, minor street) at a tick, directly from
// the definition of the seven steps.
std::array<Light, 3> lights_at(const SevenSteps& s, double offset_s, std::int64_t tick) {
    const std::int64_t cycle = to_ticks(s.cycle_s(), kStep_s);
    std::int64_t cycle_tick = ((tick - to_ticks(offset_s, kStep_s)) % cycle + cycle) % cycle;
    std::size_t step = 0;
    while (cycle_tick >= to_ticks(s.steps_s()[step], kStep_s)) cycle_tick -= to_ticks(s.steps_s()[step++], kStep_s);
    using enum Light;
    switch (step) {
        case 0:
            return {green, green, red};
        case 1:
            return {yellow, yellow, red};
        case 3:
            return {red, green, red};
        case 4:
            return {red, red, green};
        case 5:
            return {red, red, yellow};
        default:
            return {red, red, red};
    }
}

TEST(SevenSteps, MatchTheDefinitionForAnyOffset) {
    for (const SevenSteps& steps : {kProtected, kPlain, kNoClearance}) {
        for (const double offset_s : {0.0, 19.0, 40.0, 54.0, 60.0, 119.0, 1000.0}) {
            const std::array<GroupProgramme, 3> groups = make_seven_steps(steps, offset_s, kStep_s);
            for (std::int64_t tick = 0; tick < 2000; ++tick) {
                const std::array<Light, 3> expected = lights_at(steps, offset_s, tick);
                for (std::size_t g = 0; g < groups.size(); ++g) {
                    ASSERT_EQ(groups[g].light(tick), expected[g])
                        << g << " at tick " << tick << ", offset " << offset_s;
                }
            }
        }
    }
}

TEST(SevenSteps, SeparateTheMinorStreetFromTheMajorStreet) {
    for (const SevenSteps& steps : {kProtected, kPlain}) {
        const std::array<GroupProgramme, 3> groups = make_seven_steps(steps, 31.0, kStep_s);
        std::array<std::int64_t, 3> green{};
        for (std::int64_t tick = 0; tick < 600; ++tick) {
            for (std::size_t g = 0; g < 3; ++g) green[g] += groups[g].light(tick) == Light::green ? 1 : 0;
            const bool minor = groups[2].light(tick) != Light::red;
            EXPECT_FALSE(minor && groups[0].light(tick) != Light::red) << tick;
            EXPECT_FALSE(minor && groups[1].light(tick) != Light::red) << tick;
        }
        EXPECT_EQ(green[0], to_ticks(steps.major_green_s, kStep_s));
        EXPECT_EQ(green[1], to_ticks(steps.major_green_s + steps.protected_left_s, kStep_s));
        EXPECT_EQ(green[2], to_ticks(steps.minor_green_s, kStep_s));
    }
}

// light_start_tick() returns the tick at which the present light began. This tick may lie before the start of the run.
TEST(SevenSteps, ReportWhenALightStarted) {
    for (const double offset_s : {0.0, 19.0, 54.0}) {
        for (const GroupProgramme& group : make_seven_steps(kProtected, offset_s, kStep_s)) {
            EXPECT_EQ(group.cycle_ticks(), 600);
            for (std::int64_t tick = 0; tick < 1300; ++tick) {
                const std::int64_t start = group.light_start_tick(tick);
                ASSERT_LE(start, tick);
                ASSERT_GT(start, tick - 600);
                for (std::int64_t t = start; t <= tick; ++t) ASSERT_EQ(group.light(t), group.light(tick)) << tick;
                ASSERT_NE(group.light(start + 599), group.light(start + 600)) << tick;
            }
        }
    }
}

TEST(SevenSteps, KeepTheOrderOfTheIntersections) {
    StreetSettings streets;
    streets.intersections.resize(2);
    streets.intersections[1].programme = kProtected;
    streets.intersections[1].offset_s = 5.0;
    const std::vector<GroupProgramme> all = make_street_signals(streets, kStep_s);
    ASSERT_EQ(all.size(), 6u);
    EXPECT_EQ(all[0].light(0), Light::green);
    EXPECT_EQ(all[3].light(0), Light::red);
    EXPECT_EQ(all[3].light(50), Light::green);
}

}  // namespace
}  // namespace stopline
