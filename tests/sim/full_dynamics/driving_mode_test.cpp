// The driving mode is computed only when it can change. The result must equal that of an update in every step.
#include <gtest/gtest.h>

#include "base/random.h"
#include "sim/full_dynamics/driving_mode.h"
#include "v2v/fallback.h"

namespace stopline {
namespace {

V2vPlan plan_of_10_ms() {
    V2vPlan plan;
    plan.longest_age_ticks = {30, 50, 100};
    plan.hysteresis_ticks = 50;
    return plan;
}

int demanded_by(const V2vPlan& plan, int age_ticks) {
    int mode = 0;
    while (mode < 3 && age_ticks > plan.longest_age_ticks[static_cast<std::size_t>(mode)]) ++mode;
    return mode;
}

// The mode of a vehicle, computed in every step.
struct EveryStep {
    FallbackModeOf<double> memory{0.0, 0.0, 0.0};
    int since_tick = 0;

    void update(const V2vPlan& plan, int tick, const AgeOfMessages& now) {
        if (!now.has_leader) return;
        memory.ticks = tick - since_tick;
        update_mode(memory, static_cast<double>(demanded_by(plan, tick - now.sent_tick)), plan.hysteresis_ticks);
        since_tick = tick - static_cast<int>(memory.ticks);
    }
    int mode() const { return static_cast<int>(memory.mode); }
};

// Messages arrive at random intervals of up to 1.5 s, and the leader sometimes disappears for a while.
TEST(DrivingMode, IsThatOfAComputationInEveryStep) {
    const V2vPlan plan = plan_of_10_ms();
    constexpr int kTicks = 200'000;
    EveryStep expected;
    AgeOfMessages now;
    int mode = 0;
    V2vModeMemory memory;
    int next = 0;
    int updates = 0;
    int changes = 0;
    int next_message = 0;
    std::uint64_t draw = 1;
    for (int tick = 0; tick < kTicks; ++tick) {
        const AgeOfMessages before = now;
        if (tick == next_message) {
            draw = mix64(draw + 1);
            const bool is_long = draw % 4 == 0;
            next_message += 1 + static_cast<int>((draw >> 8U) % (is_long ? 150 : 40));
            now.has_leader = (draw >> 32U) % 16 != 0;
            now.sent_tick = now.has_leader ? tick - 1 - static_cast<int>((draw >> 40U) % 12) : kNeverSent;
        }
        const int mode_before = expected.mode();
        expected.update(plan, tick, now);
        changes += expected.mode() != mode_before ? 1 : 0;
        const bool is_new = now.has_leader != before.has_leader || now.sent_tick != before.sent_tick;
        if (is_new || tick >= next) {
            next = update_driving_mode(plan, tick, before, now, mode, memory);
            ++updates;
        }
        ASSERT_EQ(mode, expected.mode()) << "step " << tick;
    }
    EXPECT_GT(changes, 1000);
    EXPECT_LT(updates, kTicks / 5);
}

}  // namespace
}  // namespace stopline
