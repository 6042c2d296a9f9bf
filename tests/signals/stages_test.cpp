// Groups that have green one after the other.
#include <gtest/gtest.h>

#include "signals/programme.h"

namespace stopline {
namespace {

TEST(Stages, NeverTwoGroupsAtOnceAndAllRedBetween) {
    SignalSettings settings;
    settings.first_green_s = 10.0;
    settings.green_s = 15.0;
    settings.yellow_s = 3.0;
    settings.all_red_s = 5.0;
    for (const int groups : {2, 3}) {
        const std::vector<GroupProgramme> programmes = make_stages(settings, groups, 0.1);
        ASSERT_EQ(programmes.size(), static_cast<std::size_t>(groups));
        const std::int64_t stage = 230;
        for (std::int64_t tick = 0; tick < 100 + 3 * groups * stage; ++tick) {
            const std::int64_t since = tick - 100;
            for (int g = 0; g < groups; ++g) {
                const std::int64_t own = since - g * stage;
                const std::int64_t place = own < 0 ? groups * stage : own % (groups * stage);
                const Light expected = place < 150 ? Light::green : place < 180 ? Light::yellow : Light::red;
                ASSERT_EQ(programmes[static_cast<std::size_t>(g)].light(tick), expected) << g << " at tick " << tick;
            }
        }
    }
}

TEST(Stages, StreetsThatCrossCanHaveAGreenOfTheirOwn) {
    SignalSettings settings;
    settings.first_green_s = 1.0;
    settings.green_s = 25.0;
    settings.cross_green_s = 10.0;
    EXPECT_EQ(settings.both_stages_s(), 51.0);
    const std::vector<GroupProgramme> programmes = make_stages(settings, 2, 1.0);
    for (std::int64_t tick = 1; tick < 200; ++tick) {
        const std::int64_t place = (tick - 1) % 51;
        ASSERT_EQ(programmes[0].light(tick) == Light::green, place < 25) << tick;
        ASSERT_EQ(programmes[1].light(tick) == Light::green, place >= 33 && place < 43 && tick > 33) << tick;
    }
}

}  // namespace
}  // namespace stopline
