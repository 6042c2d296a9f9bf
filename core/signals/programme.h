// Fixed-time signal programmes: each group runs through stages of green, yellow and red, repeated with the cycle or once.
// Times are integer ticks of the simulation step.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "network/street_settings.h"
#include "signals/signal_settings.h"

namespace stopline {

struct SumoNetwork;  // network/sumo_graph.h

enum class Light : std::uint8_t { red, green, yellow };

struct Stage {
    std::int64_t ticks = 0;
    Light light = Light::red;
};

// The light of one group over time: red before `offset`, then its stages; after the last the cycle starts again, or, where
// `repeats` is false, it stays red.
class GroupProgramme {
public:
    GroupProgramme(std::vector<Stage> stages, std::int64_t offset_ticks, bool repeats);

    Light light(std::int64_t tick) const;
    // First tick of the present light, for times after `offset`, which may lie before 0; 0 before `offset`.
    std::int64_t since(std::int64_t tick) const;
    std::int64_t cycle_ticks() const { return cycle_; }

private:
    struct Place {
        std::size_t stage;
        std::int64_t begin;
    };
    Place place(std::int64_t tick) const;

    std::vector<Stage> stages_;
    std::int64_t offset_;
    std::int64_t cycle_ = 0;
    bool repeats_;
};

// Green, yellow, then red for the rest of the cycle. Throws InputError where the parts do not fit into the cycle.
GroupProgramme make_single_light(const SignalSettings& settings, double step_s);

// Groups that have green one after the other, `groups` stages of green, yellow and all red to a cycle. `cycle_s` is not used.
std::vector<GroupProgramme> make_stages(const SignalSettings& settings, int groups, double step_s);

// The programme of an intersection in seven steps (Table 3), a programme for each signal group of make_streets(): the major street, its
// lanes that only turn left, the minor street. They run from the beginning: at time 0 a programme is where its offset, counted in
// whole cycles, puts it. Lanes that only turn left have green with the major street, where they give way, and on their own later.
std::array<GroupProgramme, 3> make_seven_steps(const SevenSteps& steps, double offset_s, double step_s);
std::vector<GroupProgramme> make_street_signals(const StreetSettings& streets, double step_s);

// Of each signal group of an imported network. At time t a programme is where it is (t - offset) after its beginning, in every cycle; the
// letters G g s o O are green, y Y yellow, all others red.
std::vector<GroupProgramme> make_sumo_signals(const SumoNetwork& network, double step_s);

// Seconds to whole ticks, rounded to the nearest.
std::int64_t to_ticks(double seconds, double step_s);

}  // namespace stopline
