// Signal phases. A phase gives green to some groups of a signal for some time. Yellow follows for the groups that lose
// green, then red for all of them, then the next phase. A group that has green in the next phase too keeps its green.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "signals/programme.h"
#include "signals/rings/ring_plan.h"
#include "signals/signal_settings.h"
#include "signals/timeline.h"

namespace stopline {

inline constexpr double kDay_s = 86'400.0;

enum class Recall : std::uint8_t { off, minimum, maximum };

// Times are in ticks.
struct SignalPhase {
    std::uint64_t green_groups = 0;  // groups with green; bit k stands for group k of the signal
    std::int64_t green_ticks = 0;
    std::int64_t yellow_ticks = 0;
    std::int64_t all_red_ticks = 0;
    // For controllers that react to traffic, see PhaseSettings:
    std::int64_t min_green_ticks = 0;
    std::int64_t max_green_ticks = 0;
    std::int64_t gap_ticks = 0;
    Recall recall = Recall::off;

    bool has_green(int group) const { return (green_groups >> group & 1U) != 0; }
    std::int64_t ticks() const { return green_ticks + yellow_ticks + all_red_ticks; }
};

// A sequence of phases that repeats.
struct PhaseProgramme {
    std::int64_t from_tick = 0;  // time of day from which the programme is in force
    int first_phase = 0;         // index in PhasePlan::phases
    int phases = 0;              // number of phases
    std::int64_t cycle_ticks = 0;

    int last_phase() const { return first_phase + phases - 1; }
};

// The phases of one signal. Without phases, both lists are empty.
struct PhasePlan {
    std::vector<SignalPhase> phases;         // of all programmes, one programme after the other
    std::vector<PhaseProgramme> programmes;  // in the order of from_tick
    std::int64_t clock_ticks = 0;            // time of day at tick 0
    std::int64_t day_ticks = 0;
    RingPlan rings;  // for controllers with rings; streets set only RingPhase::protected_groups

    bool empty() const { return phases.empty(); }
    // Returns the index of the programme that is in force at a tick of the run.
    int programme_at(std::int64_t tick) const;
    // Returns the first tick after `tick` at which a programme comes into force.
    std::int64_t next_programme_tick(std::int64_t tick) const;
    // Returns the light of a group after the green of phase `phase`, during yellow or red, if phase `next` follows.
    Light light_after(int phase, int next, int group, Light light) const {
        const SignalPhase& ending = phases[static_cast<std::size_t>(phase)];
        if (!ending.has_green(group)) return Light::red;
        return phases[static_cast<std::size_t>(next)].has_green(group) ? Light::green : light;
    }
};

// The cycle and the green time that rules and measures use where they need a constant. A controller that reacts to
// traffic gives the values that it would have in steady traffic.
struct NominalCycle {
    double cycle_s = 0.0;  // 0: the signal does not repeat
    double longest_green_s = 0.0;
};

// The programmes of a signal with phases over time.
struct PhaseTimelines {
    Timeline<int> phase;                     // index of the phase whose green began last; -1 before the first green
    std::vector<GroupProgramme> programmes;  // [group of the signal]
};

// Returns the programmes of the settings. SignalSettings::phases count as one programme.
std::vector<ProgrammeSettings> phase_programmes(const SignalSettings& settings);

// Returns the longest cycle and the longest green of all programmes. A movement that keeps its green into the next
// phase has one green.
NominalCycle phase_cycle(const SignalSettings& settings);
// Returns the cycle of the programme that is in force at the start of the run, s.
double first_cycle_s(const SignalSettings& settings);
// Returns the middle of the second green of a cycle, from the start of the cycle, s. The settings need not have phases.
double second_green_middle_s(const SignalSettings& settings);

// Returns true if a phase gives green, or protected green, to the movement with this name.
bool has_protected_green(const PhaseSettings& phase, const std::string& movement);
bool has_green(const PhaseSettings& phase, const std::string& movement);
// Returns the group of each movement within its signal, counted from 0. Movements that have green in the same phases of
// all programmes share a group. `by_protection`: the green must also be protected in the same phases.
std::vector<int> groups_with_equal_lights(const SignalSettings& settings, std::span<const std::string> movements,
                                          bool by_protection);

// Converts the settings. `movements`: the name of a movement of each group of the signal.
PhasePlan make_phase_plan(const SignalSettings& settings, std::span<const std::string> movements, double step_s);

// Returns the lights of a fixed-time signal. It is red before `first_tick`, when the first phase begins. Another
// programme begins at the end of the cycle in which it comes into force. After the tick `end_tick`, the programme does
// not change any more.
PhaseTimelines make_phase_timelines(const PhasePlan& plan, int groups, std::int64_t first_tick, std::int64_t end_tick);

}  // namespace stopline
