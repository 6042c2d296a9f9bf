// A value that changes at given ticks, such as the light of a signal group. The timeline consists of parts. Each part
// repeats its stages until the next part begins. The last part repeats without end.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace stopline {

template <class Value>
class Timeline {
public:
    struct Stage {
        std::int64_t ticks = 0;  // duration, above 0
        Value value = {};
    };
    struct Part {
        std::int64_t start_tick = 0;
        std::vector<Stage> stages;  // not empty
    };

    Timeline() = default;
    // `before`: the value before the first part. The parts are in the order of their start ticks.
    Timeline(Value before, std::vector<Part> parts) : before_(before), parts_(std::move(parts)) {
        for (const Part& part : parts_) {
            std::int64_t cycle = 0;
            for (const Stage& stage : part.stages) cycle += stage.ticks;
            cycles_.push_back(cycle);
        }
    }

    bool empty() const { return parts_.empty(); }
    std::int64_t first_tick() const { return parts_.front().start_tick; }
    const std::vector<Part>& parts() const { return parts_; }
    Value at(std::int64_t tick) const { return place_at(tick).value; }

    // Returns the tick at which the value at `tick` began. Before the first part, returns 0.
    std::int64_t start_tick(std::int64_t tick) const {
        if (tick < first_tick()) return 0;
        Place place = place_at(tick);
        while (place.begin_tick > first_tick()) {
            const Place previous = place_at(place.begin_tick - 1);
            if (previous.value != place.value) break;
            place = previous;
        }
        return place.begin_tick;
    }

    // Returns the first tick after `tick` at which the value changes; the highest possible tick if there is none.
    std::int64_t next_change_tick(std::int64_t tick) const {
        const Value value = at(tick);
        // A whole cycle of the last part without a change means that the value never changes.
        const std::int64_t limit = std::max(tick, parts_.back().start_tick) + cycles_.back();
        std::int64_t next_tick = place_at(tick).end_tick;
        while (next_tick <= limit && at(next_tick) == value) next_tick = place_at(next_tick).end_tick;
        return next_tick <= limit ? next_tick : std::numeric_limits<std::int64_t>::max();
    }

private:
    struct Place {
        Value value;
        std::int64_t begin_tick;  // start of the stage
        std::int64_t end_tick;    // end of the stage
    };
    Place place_at(std::int64_t tick) const {
        const auto later = std::upper_bound(parts_.begin(), parts_.end(), tick,
                                            [](std::int64_t t, const Part& part) { return t < part.start_tick; });
        constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
        const std::int64_t part_end_tick = later == parts_.end() ? kNever : later->start_tick;
        if (later == parts_.begin()) return {before_, 0, part_end_tick};
        const auto part = std::prev(later);
        const std::int64_t cycle = cycles_[static_cast<std::size_t>(part - parts_.begin())];
        std::int64_t begin_tick = tick - (tick - part->start_tick) % cycle;
        std::size_t stage = 0;
        while (tick >= begin_tick + part->stages[stage].ticks) begin_tick += part->stages[stage++].ticks;
        return {part->stages[stage].value, begin_tick, std::min(begin_tick + part->stages[stage].ticks, part_end_tick)};
    }

    Value before_ = {};
    std::vector<Part> parts_;
    std::vector<std::int64_t> cycles_;  // [part] sum of the durations of its stages
};

}  // namespace stopline
