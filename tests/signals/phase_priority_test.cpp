// Tests of right of way that changes with the phases of a signal, against a timeline that lists every tick.
#include "signals/phase_priority.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/input_error.h"

namespace stopline {
namespace {

constexpr Priority kFirst{true, false};
constexpr Priority kSecond{false, true};

TEST(PhasePriority, RepeatsItsStages) {
    for (const std::int64_t offset : {0, 4, -3, 17}) {
        const PhasePriority programme(7, 9, {{3, kFirst}, {5, kSecond}, {2, kFirst}}, offset);
        EXPECT_EQ(programme.first(), 7);
        EXPECT_EQ(programme.second(), 9);
        const std::vector<Priority> cycle{kFirst,  kFirst,  kFirst,  kSecond, kSecond,
                                          kSecond, kSecond, kSecond, kFirst,  kFirst};
        for (std::int64_t tick = -20; tick < 40; ++tick) {
            const auto place = static_cast<std::size_t>(((tick - offset) % 10 + 10) % 10);
            EXPECT_EQ(programme.at(tick), cycle[place]) << "tick " << tick << ", offset " << offset;
            std::int64_t next = tick + 1;
            const auto begins_stage = [&](std::int64_t t) {
                const std::int64_t in_cycle = ((t - offset) % 10 + 10) % 10;
                return in_cycle == 0 || in_cycle == 3 || in_cycle == 8;
            };
            while (!begins_stage(next)) ++next;
            EXPECT_EQ(programme.next_change_tick(tick), next) << "tick " << tick << ", offset " << offset;
        }
    }
}

TEST(PhasePriority, RefusesEmptyStages) {
    EXPECT_THROW(PhasePriority(0, 1, {}, 0), InputError);
    EXPECT_THROW(PhasePriority(0, 1, {{0, kFirst}}, 0), InputError);
}

}  // namespace
}  // namespace stopline
