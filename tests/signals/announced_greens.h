// Checks that a controller keeps the greens that it announces (SignalController::next_green).
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "signals/actuated_junction.h"

namespace stopline {

// Call observe() after each tick of the junction.
class AnnouncedGreens {
public:
    void observe(Junction& junction) {
        const std::size_t groups = junction.state().lights.size();
        promised_.resize(groups);
        for (std::size_t group = 0; group < groups; ++group) {
            GreenWindow& promised = promised_[group];
            const std::int64_t tick = junction.tick();
            const bool is_pending = promised.is_known() && tick < promised.until_tick;
            if (is_pending && tick >= promised.from_tick) {
                ASSERT_EQ(junction.light(group), Light::green) << "group " << group << " at tick " << tick;
            }
            const GreenWindow now = junction.next_green(static_cast<int>(group));
            if (is_pending) {
                ASSERT_LE(now.from_tick, promised.from_tick) << "group " << group << " at tick " << tick;
            }
            if (!now.is_known()) continue;
            if (now.from_tick > tick) ++announced_ahead;
            if (now.from_tick <= tick && now.until_tick > tick + 1) ++announced_rests;
            promised = {now.from_tick, is_pending ? std::max(promised.until_tick, now.until_tick) : now.until_tick};
        }
    }

    int announced_ahead = 0;  // announcements of a green that has not begun
    int announced_rests = 0;  // announcements that the present green lasts

private:
    std::vector<GreenWindow> promised_;  // [group]
};

}  // namespace stopline
