// Fixed-time signal programmes. Each signal group runs through stages of green, yellow and red, either a single time or
// again in each cycle. Times and durations are in ticks, which are simulation steps. Tick 0 is the beginning of the
// run.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "network/street_settings.h"
#include "signals/signal_settings.h"
#include "signals/timeline.h"

namespace stopline {

enum class Light : std::uint8_t { red, green, yellow };

// Stands for the start tick of the latest green if there has been no green yet. Negative values are ordinary ticks.
inline constexpr std::int64_t kNoGreen = std::numeric_limits<std::int64_t>::min();

struct Stage {
    std::int64_t ticks = 0;  // duration
    Light light = Light::red;
};

// The light of one signal group over time. Before the tick `offset_ticks` the light is red. Then the stages follow.
// After the last stage the programme starts again. If the programme does not repeat, the light stays red instead.
class GroupProgramme {
public:
    // Throws InputError if there is no stage or if a stage lasts less than one tick.
    GroupProgramme(std::vector<Stage> stages, std::int64_t offset_ticks, bool repeats);
    // Makes a programme whose cycles can differ. `lights` has at least one part, and `cycle_ticks` is its cycle for
    // measures and rules that need a single one.
    GroupProgramme(Timeline<Light> lights, std::int64_t cycle_ticks);

    Light light(std::int64_t tick) const;
    // Returns the tick at which the stage at `tick` began. The result can be negative, because the offset can be
    // negative. For the red before the offset the result is 0. For the red after a programme that does not repeat, the
    // result is the end of the last stage.
    std::int64_t light_start_tick(std::int64_t tick) const;
    // Returns the start of the latest green that was shown at any tick from 0 to `tick`, or kNoGreen if there was none.
    // The start can be negative.
    std::int64_t last_green_start_tick(std::int64_t tick) const;
    // Returns the first tick after `tick` at which a stage begins or the programme ends. Returns the highest possible
    // tick if there is none.
    std::int64_t next_change_tick(std::int64_t tick) const;
    std::int64_t cycle_ticks() const { return cycle_; }
    std::int64_t first_tick() const { return offset_; }
    // Returns true if the light is always the same.
    bool never_changes() const { return stages_.size() == 1 && repeats_; }

private:
    struct StageStart {
        std::size_t stage;
        std::int64_t tick;
    };
    // Returns the stage at `tick`, and the tick at which this stage began. `tick` must not be before the offset. The
    // function treats every programme as repeating.
    StageStart stage_at(std::int64_t tick) const;

    std::vector<Stage> stages_;
    std::int64_t offset_;
    std::int64_t cycle_ = 0;
    bool repeats_;
    Timeline<Light> timeline_;  // empty: the members above apply
};

// Makes a programme of green, yellow, and red for the rest of the cycle. If `settings.cycle_s` is 0, the programme does
// not repeat. Throws InputError if green, yellow and all-red times together are longer than the cycle.
GroupProgramme make_single_light(const SignalSettings& settings, double step_s);

// Makes the programmes of `groups` signal groups that have green one after the other. The cycle is the sum of the
// green, yellow and all-red times of all groups. `settings.cycle_s` is ignored.
std::vector<GroupProgramme> make_stage_programmes(const SignalSettings& settings, int groups, double step_s);

// Makes the seven-step programme of an intersection (Table 3 of the paper). The three signal groups are those of
// make_streets(): the major street, its left-turn lanes and the minor street. Left-turn lanes have a permissive green
// together with the major street, and later a protected green. A cycle begins at `offset_s`. The cycle also repeats
// before that time, so the programmes run from time 0 on.
std::array<GroupProgramme, 3> make_seven_steps(const SevenSteps& steps, double offset_s, double step_s);
// Makes the programmes of all signal groups of make_streets(), in the order of the groups.
std::vector<GroupProgramme> make_street_signals(const StreetSettings& streets, double step_s);

// Converts seconds to the nearest number of ticks.
std::int64_t to_ticks(double seconds, double step_s);

}  // namespace stopline
