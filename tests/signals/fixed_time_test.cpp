// The controller `fixed_time`: its lights are those of the programmes at every tick, although it is called only when a
// light changes.
#include <gtest/gtest.h>

#include <vector>

#include "base/input_error.h"
#include "signals/signal_controller.h"

namespace stopline {
namespace {

// Runs the controller of a plan tick by tick, as a simulation does.
class Signal {
public:
    explicit Signal(SignalPlan plan) : plan_(std::move(plan)) {
        state_.lights.resize(plan_.groups.size());
        state_.since_tick.resize(plan_.groups.size());
        state_.green_start_tick.resize(plan_.groups.size());
        state_.memory.resize(1);
        state_.detectors.resize(1);
        SignalView view(plan_, 0, 0, state_);
        next_tick_ = plan_.controller->init(view);
    }

    void step(std::int64_t tick) {
        if (tick < next_tick_) return;
        SignalView view(plan_, 0, tick, state_);
        next_tick_ = plan_.controller->step(view);
        ++steps_;
    }

    const SignalState& state() const { return state_; }
    int steps() const { return steps_; }

private:
    SignalPlan plan_;
    SignalState state_;
    std::int64_t next_tick_ = 0;
    int steps_ = 0;
};

void expect_same_lights(const std::vector<GroupProgramme>& programmes) {
    Signal signal(fixed_time_plan(0, programmes));
    for (std::int64_t tick = 0; tick < 500; ++tick) {
        if (tick > 0) signal.step(tick);
        for (std::size_t k = 0; k < programmes.size(); ++k) {
            ASSERT_EQ(signal.state().lights[k], programmes[k].light(tick)) << tick;
            ASSERT_EQ(signal.state().since_tick[k], programmes[k].light_start_tick(tick)) << tick;
            ASSERT_EQ(signal.state().green_start_tick[k], programmes[k].last_green_start_tick(tick)) << tick;
        }
    }
}

TEST(FixedTime, FollowsTheProgrammes) {
    for (const std::int64_t offset : {-25, 0, 13}) {
        const std::vector<Stage> first{{20, Light::green}, {3, Light::yellow}, {30, Light::red}};
        expect_same_lights({GroupProgramme(first, offset, true)});
        expect_same_lights({GroupProgramme(first, offset, true), GroupProgramme(first, offset + 26, true)});
    }
    expect_same_lights({GroupProgramme({{20, Light::green}, {3, Light::yellow}}, 40, false)});
}

TEST(FixedTime, IsCalledOnlyWhenALightChanges) {
    Signal signal(fixed_time_plan(0, {GroupProgramme({{20, Light::green}, {30, Light::red}}, 10, true)}));
    for (std::int64_t tick = 1; tick < 500; ++tick) signal.step(tick);
    EXPECT_EQ(signal.steps(), 20);
}

TEST(FixedTime, HasTheCycleOfTheStages) {
    const SignalSettings settings{
        .green_s = 10.0, .yellow_s = 3.0, .all_red_s = 5.0, .cross_green_s = 20.0, .cycle_s = 45.0};
    EXPECT_EQ(nominal_cycle(settings, 2).cycle_s, 46.0);
    EXPECT_EQ(nominal_cycle(settings, 2).longest_green_s, 20.0);
    EXPECT_EQ(nominal_cycle(settings, 1).cycle_s, 45.0);
}

TEST(SignalPlans, FindTheProgrammeOfAGroup) {
    const auto red_for = [](std::int64_t ticks) { return GroupProgramme({{ticks, Light::red}}, 0, true); };
    SignalPlans plans;
    plans.add(fixed_time_plan({0, 3}, {red_for(10), red_for(13)}));
    EXPECT_FALSE(plans.is_complete());
    plans.add(fixed_time_plan(1, {red_for(11), red_for(12)}));
    EXPECT_TRUE(plans.is_complete());
    ASSERT_EQ(plans.groups(), 4);
    for (int group = 0; group < 4; ++group) EXPECT_EQ(plans.programme(group).cycle_ticks(), 10 + group);
}

TEST(SignalControllers, AnUnknownNameIsRefused) {
    EXPECT_EQ(find_signal_controller("fixed_time").follows_programme, true);
    EXPECT_THROW(find_signal_controller("fixed"), InputError);
}

}  // namespace
}  // namespace stopline
