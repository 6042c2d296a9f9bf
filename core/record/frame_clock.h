// When a writer looks: every so many ticks, within a part of the run.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "signals/programme.h"

namespace stopline {

struct RecordingWindow {
    double interval_s = 1.0;
    double from_s = 0.0;
    double until_s = std::numeric_limits<double>::infinity();
};

class FrameClock {
public:
    FrameClock(const RecordingWindow& window, double step_s)
        : every_(std::max<std::int64_t>(to_ticks(window.interval_s, step_s), 1)),
          first_(std::llround(std::ceil(window.from_s / step_s / static_cast<double>(every_) - 1e-9)) * every_),
          last_(std::isfinite(window.until_s) ? to_ticks(window.until_s, step_s)
                                              : std::numeric_limits<std::int64_t>::max()) {}

    bool is_due(std::int64_t tick) const { return tick >= first_ && tick <= last_ && (tick - first_) % every_ == 0; }
    std::int64_t first_tick() const { return first_; }
    std::int64_t every_ticks() const { return every_; }

private:
    std::int64_t every_;
    std::int64_t first_;
    std::int64_t last_;
};

}  // namespace stopline
