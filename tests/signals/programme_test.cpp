// Tests of fixed-time programmes against a timeline that lists every tick.
#include "signals/programme.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/input_error.h"

namespace stopline {
namespace {

struct Case {
    std::vector<Stage> stages;
    std::int64_t offset;
    bool repeats;
};

const Case kCases[] = {
    {{{3, Light::green}, {2, Light::yellow}, {4, Light::red}}, 0, true},
    {{{3, Light::green}, {2, Light::yellow}, {4, Light::red}}, 7, true},
    {{{3, Light::green}, {2, Light::yellow}, {4, Light::red}}, 7, false},
    {{{3, Light::green}, {2, Light::yellow}, {4, Light::red}}, 1000, true},
    {{{5, Light::green}}, 2, false},
    {{{5, Light::green}}, 2, true},
    {{{1, Light::red}, {1, Light::green}}, 0, true},
    {{{2, Light::green}, {3, Light::red}, {1, Light::green}, {1, Light::yellow}, {6, Light::red}}, 5, true},
    {{{2, Light::green}, {3, Light::red}, {1, Light::green}, {1, Light::yellow}, {6, Light::red}}, 5, false},
    {{{1500, Light::green}, {300, Light::yellow}, {2800, Light::red}}, 450, true},
};
constexpr std::int64_t kTicks = 20'000;

// The light of each tick and the tick at which its stage began. The light is red before the offset, and stays red after
// a programme that does not repeat.
struct Timeline {
    std::vector<Light> light;
    std::vector<std::int64_t> since;
};

Timeline timeline_of(const Case& c) {
    Timeline line;
    const auto append = [&](Light light, std::int64_t ticks, std::int64_t since) {
        for (std::int64_t k = 0; k < ticks; ++k) {
            line.light.push_back(light);
            line.since.push_back(since);
        }
    };
    append(Light::red, c.offset, 0);
    do {
        for (const Stage& stage : c.stages) {
            append(stage.light, stage.ticks, static_cast<std::int64_t>(line.light.size()));
        }
    } while (c.repeats && static_cast<std::int64_t>(line.light.size()) < kTicks);
    append(Light::red, kTicks, static_cast<std::int64_t>(line.light.size()));
    return line;
}

class Programme : public testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Timelines, Programme, testing::ValuesIn(kCases));

TEST_P(Programme, MatchesTheTimeline) {
    const GroupProgramme programme(GetParam().stages, GetParam().offset, GetParam().repeats);
    const Timeline line = timeline_of(GetParam());
    for (std::int64_t tick = 0; tick < kTicks; ++tick) {
        ASSERT_EQ(programme.light(tick), line.light[static_cast<std::size_t>(tick)]) << tick;
        ASSERT_EQ(programme.light_start_tick(tick), line.since[static_cast<std::size_t>(tick)]) << tick;
    }
}

TEST_P(Programme, ReportsItsCycle) {
    std::int64_t sum = 0;
    for (const Stage& stage : GetParam().stages) sum += stage.ticks;
    EXPECT_EQ(GroupProgramme(GetParam().stages, GetParam().offset, GetParam().repeats).cycle_ticks(), sum);
}

// A green that began at tick -1 is a green.
TEST(Programme, LastGreenCanBeginBeforeTheRun) {
    const std::vector<Stage> stages{{3, Light::green}, {2, Light::yellow}, {4, Light::red}};
    EXPECT_EQ(GroupProgramme(stages, -1, true).last_green_start_tick(5), -1);
    EXPECT_EQ(GroupProgramme(stages, -1, false).last_green_start_tick(50), -1);
    EXPECT_EQ(GroupProgramme(stages, 1, true).last_green_start_tick(0), kNoGreen);
    EXPECT_EQ(GroupProgramme(stages, -4, false).last_green_start_tick(50), kNoGreen);  // over before the run
}

TEST(Programme, RefusesStagesWithoutDuration) {
    EXPECT_THROW(GroupProgramme({}, 0, true), InputError);
    EXPECT_THROW(GroupProgramme({{0, Light::green}}, 0, true), InputError);
    EXPECT_THROW(GroupProgramme({{5, Light::green}, {-1, Light::red}}, 0, true), InputError);
}

}  // namespace
}  // namespace stopline
