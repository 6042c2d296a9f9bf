// Tests of make_single_light(): from signal settings to a programme.
#include <gtest/gtest.h>

#include "base/input_error.h"
#include "signals/programme.h"

namespace stopline {
namespace {

constexpr double kSteps[] = {0.02, 0.01, 0.005};

SignalSettings intersection() {
    SignalSettings s;
    s.first_green_s = 12.3;
    s.green_s = 15.0;
    s.yellow_s = 3.0;
    s.all_red_s = 5.0;
    s.cycle_s = 46.0;
    return s;
}

// Returns the light in the step that contains a time. 1e-6 absorbs rounding errors.
Light light_at(const SignalSettings& s, double time_s, double step_s) {
    return make_single_light(s, step_s).light(static_cast<std::int64_t>(time_s / step_s + 1e-6));
}

TEST(SingleLight, RepeatsItsCycleFromTheFirstGreen) {
    for (const double step : kSteps) {
        for (int cycle = 0; cycle < 20; ++cycle) {
            const double start = 12.3 + 46.0 * cycle;
            EXPECT_EQ(light_at(intersection(), start - step, step), Light::red);
            EXPECT_EQ(light_at(intersection(), start, step), Light::green);
            EXPECT_EQ(light_at(intersection(), start + 15.0 - step, step), Light::green);
            EXPECT_EQ(light_at(intersection(), start + 15.0, step), Light::yellow);
            EXPECT_EQ(light_at(intersection(), start + 18.0 - step, step), Light::yellow);
            EXPECT_EQ(light_at(intersection(), start + 18.0, step), Light::red);
        }
    }
}

TEST(SingleLight, IsGreenOnceWithoutACycle) {
    SignalSettings s = intersection();
    s.cycle_s = 0.0;
    for (const double step : kSteps) {
        EXPECT_EQ(light_at(s, 0.0, step), Light::red);
        EXPECT_EQ(light_at(s, 12.3, step), Light::green);
        EXPECT_EQ(light_at(s, 28.0, step), Light::yellow);
        for (double t = 30.3; t < 500.0; t += 0.7) ASSERT_EQ(light_at(s, t, step), Light::red) << t;
    }
}

TEST(SingleLight, WorksWithoutYellow) {
    SignalSettings s = intersection();
    s.yellow_s = 0.0;
    EXPECT_EQ(light_at(s, 12.3 + 15.0, 0.01), Light::red);
    EXPECT_EQ(light_at(s, 12.3 + 46.0, 0.01), Light::green);
}

TEST(SingleLight, RefusesACycleThatIsTooShort) {
    SignalSettings s = intersection();
    s.cycle_s = 15.0 + 3.0 + 5.0;
    EXPECT_NO_THROW(make_single_light(s, 0.01));
    s.cycle_s = 22.9;
    EXPECT_THROW(make_single_light(s, 0.01), InputError);
    s.cycle_s = 10.0;
    EXPECT_THROW(make_single_light(s, 0.01), InputError);
}

TEST(SingleLight, RefusesAZeroGreenTime) {
    SignalSettings s = intersection();
    s.green_s = 0.0;
    EXPECT_THROW(make_single_light(s, 0.01), InputError);
}

// In binary, 0.15 / 0.01 is not exactly 15. Ticks must be rounded, not truncated.
TEST(Ticks, AreRounded) {
    for (int k = 0; k < 100'000; ++k) {
        ASSERT_EQ(to_ticks(k * 0.01, 0.01), k);
        ASSERT_EQ(to_ticks(k / 200.0, 0.005), k);
    }
}

}  // namespace
}  // namespace stopline
