// Tests of make_stage_programmes(): signal groups that are green one after another.
#include <gtest/gtest.h>

#include "signals/programme.h"

namespace stopline {
namespace {

TEST(Stages, ServeOneGroupAtATimeWithAllRedBetween) {
    SignalSettings settings;
    settings.first_green_s = 10.0;
    settings.green_s = 15.0;
    settings.yellow_s = 3.0;
    settings.all_red_s = 5.0;
    for (const int groups : {2, 3}) {
        const std::vector<GroupProgramme> programmes = make_stage_programmes(settings, groups, 0.1);
        ASSERT_EQ(programmes.size(), static_cast<std::size_t>(groups));
        const std::int64_t stage_ticks = 230;
        for (std::int64_t tick = 0; tick < 100 + 3 * groups * stage_ticks; ++tick) {
            const std::int64_t elapsed = tick - 100;
            for (int g = 0; g < groups; ++g) {
                const std::int64_t group_elapsed = elapsed - g * stage_ticks;
                const std::int64_t cycle_tick =
                    group_elapsed < 0 ? groups * stage_ticks : group_elapsed % (groups * stage_ticks);
                const Light expected = cycle_tick < 150 ? Light::green : cycle_tick < 180 ? Light::yellow : Light::red;
                ASSERT_EQ(programmes[static_cast<std::size_t>(g)].light(tick), expected) << g << " at tick " << tick;
            }
        }
    }
}

TEST(Stages, CrossStreetsCanHaveTheirOwnGreenTime) {
    SignalSettings settings;
    settings.first_green_s = 1.0;
    settings.green_s = 25.0;
    settings.cross_green_s = 10.0;
    EXPECT_EQ(settings.intersection_cycle_s(), 51.0);
    const std::vector<GroupProgramme> programmes = make_stage_programmes(settings, 2, 1.0);
    for (std::int64_t tick = 1; tick < 200; ++tick) {
        const std::int64_t cycle_tick = (tick - 1) % 51;
        ASSERT_EQ(programmes[0].light(tick) == Light::green, cycle_tick < 25) << tick;
        ASSERT_EQ(programmes[1].light(tick) == Light::green, cycle_tick >= 33 && cycle_tick < 43 && tick > 33) << tick;
    }
}

}  // namespace
}  // namespace stopline
