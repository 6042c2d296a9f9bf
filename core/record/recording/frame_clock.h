// The times at which a writer records the state of a run. Each recorded state is a frame.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "signals/programme.h"

namespace stopline {

// The part of the run to record. `interval_s` is the time from one frame to the next.
struct RecordingWindow {
    double interval_s = 1.0;
    double from_s = 0.0;
    double until_s = std::numeric_limits<double>::infinity();
};

// Tells at which ticks a frame is due: at all multiples of the interval, from `from_s` to `until_s`.
class FrameClock {
public:
    FrameClock(const RecordingWindow& window, double step_s)
        : interval_ticks_(std::max<std::int64_t>(to_ticks(window.interval_s, step_s), 1)),
          first_tick_(std::llround(std::ceil(window.from_s / step_s / static_cast<double>(interval_ticks_) - 1e-9)) *
                      interval_ticks_),
          last_tick_(std::isfinite(window.until_s) ? to_ticks(window.until_s, step_s)
                                                   : std::numeric_limits<std::int64_t>::max()) {}

    bool is_due(std::int64_t tick) const {
        return tick >= first_tick_ && tick <= last_tick_ && (tick - first_tick_) % interval_ticks_ == 0;
    }
    std::int64_t first_tick() const { return first_tick_; }
    std::int64_t frame_ticks() const { return interval_ticks_; }

private:
    std::int64_t interval_ticks_;
    std::int64_t first_tick_;
    std::int64_t last_tick_;
};

}  // namespace stopline
