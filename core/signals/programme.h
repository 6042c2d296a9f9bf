// Fixed-time signal programmes. Each signal group runs through stages of green, yellow and red, either once or in every
// cycle. Times are in ticks of the simulation step.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "network/street_settings.h"
#include "signals/signal_settings.h"

namespace stopline {

enum class Light : std::uint8_t { red, green, yellow };

struct Stage {
    std::int64_t ticks = 0;
    Light light = Light::red;
};

// The light of one signal group over time. It is red before the offset; then its stages follow. After the last stage
// the programme starts again, or stays red if it does not repeat.
class GroupProgramme {
public:
    // Throws InputError if there is no stage or if a stage lasts less than one tick.
    GroupProgramme(std::vector<Stage> stages, std::int64_t offset_ticks, bool repeats);

    Light light(std::int64_t tick) const;
    // Returns the first tick of the light that is shown at `tick`. It can be negative. Before the offset it is 0.
    std::int64_t light_start_tick(std::int64_t tick) const;
    // Returns the first tick of the latest green that began at or before `tick`, or -1 if there was none.
    std::int64_t last_green_start_tick(std::int64_t tick) const;
    std::int64_t cycle_ticks() const { return cycle_; }

private:
    struct StageStart {
        std::size_t stage;
        std::int64_t tick;
    };
    // Returns the stage at `tick` and its first tick, for a programme that repeats.
    StageStart stage_at(std::int64_t tick) const;

    std::vector<Stage> stages_;
    std::int64_t offset_;
    std::int64_t cycle_ = 0;
    bool repeats_;
};

// Makes a programme of green, yellow, and red for the rest of the cycle. Throws InputError if green, yellow and all red
// are longer than the cycle.
GroupProgramme make_single_light(const SignalSettings& settings, double step_s);

// Makes the programmes of `groups` signal groups that have green one after the other. The cycle is the sum of their
// green, yellow and all-red times; the field `cycle_s` is not used.
std::vector<GroupProgramme> make_stage_programmes(const SignalSettings& settings, int groups, double step_s);

// Makes the seven-step programme of an intersection (Table 3) for the signal groups of make_streets(): the major
// street, its left-turn lanes and the minor street. Left-turn lanes have a permissive green together with the major
// street, and later a protected green. The programmes run from time 0 on, as if they had been started at the offset of
// an earlier cycle.
std::array<GroupProgramme, 3> make_seven_steps(const SevenSteps& steps, double offset_s, double step_s);
// Makes the programmes of all signal groups of make_streets(), in order.
std::vector<GroupProgramme> make_street_signals(const StreetSettings& streets, double step_s);

// Converts seconds to ticks, rounded to the nearest.
std::int64_t to_ticks(double seconds, double step_s);

}  // namespace stopline
