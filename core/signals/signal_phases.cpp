#include "signals/signal_phases.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>

namespace stopline {

namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

SignalPhase phase_of(const PhaseSettings& settings, std::span<const std::string> movements, double step_s) {
    SignalPhase phase;
    for (std::size_t k = 0; k < movements.size(); ++k) {
        if (has_green(settings, movements[k])) phase.green_groups |= std::uint64_t{1} << k;
    }
    phase.green_ticks = to_ticks(settings.green_s, step_s);
    phase.yellow_ticks = to_ticks(settings.yellow_s, step_s);
    phase.all_red_ticks = to_ticks(settings.all_red_s, step_s);
    phase.min_green_ticks = to_ticks(settings.min_green_s, step_s);
    phase.max_green_ticks = to_ticks(settings.longest_green_s(), step_s);
    phase.gap_ticks = to_ticks(settings.gap_s, step_s);
    phase.recall = settings.recall == "maximum"   ? Recall::maximum
                   : settings.recall == "minimum" ? Recall::minimum
                                                  : Recall::off;
    return phase;
}

// Returns the longest green of one movement in a programme, s. The search looks at greens that begin in each phase.
double longest_green_s(const ProgrammeSettings& programme, const std::string& movement) {
    const std::vector<PhaseSettings>& phases = programme.phases;
    const std::size_t count = phases.size();
    double longest_s = 0.0;
    for (std::size_t first = 0; first < count; ++first) {
        double green_s = 0.0;
        for (std::size_t k = 0; k < count && has_green(phases[(first + k) % count], movement); ++k) {
            const PhaseSettings& phase = phases[(first + k) % count];
            const bool goes_on = has_green(phases[(first + k + 1) % count], movement);
            green_s += goes_on ? phase.total_s() : phase.green_s;
        }
        longest_s = std::max(longest_s, green_s);
    }
    return longest_s;
}

// A time in which one programme repeats.
struct ProgrammeSpan {
    std::int64_t start_tick;
    std::size_t programme;
    std::size_t next_programme;  // programme after the last cycle of the span
};

// Returns the spans from `first_tick` to the end of the run. The last cycle before another programme is a span of its
// own, because its lights depend on the phase that follows.
std::vector<ProgrammeSpan> programme_spans(const PhasePlan& plan, std::int64_t first_tick, std::int64_t end_tick) {
    std::vector<ProgrammeSpan> spans;
    std::int64_t start = first_tick;
    for (;;) {
        const auto programme = static_cast<std::size_t>(plan.programme_at(start));
        const std::int64_t change = plan.next_programme_tick(start);
        if (change > end_tick) {
            spans.push_back({start, programme, programme});
            return spans;
        }
        const std::int64_t cycle = plan.programmes[programme].cycle_ticks;
        const std::int64_t end = start + (change - start + cycle - 1) / cycle * cycle;
        if (end - cycle > start) spans.push_back({start, programme, programme});
        spans.push_back({end - cycle, programme, static_cast<std::size_t>(plan.programme_at(end))});
        start = end;
    }
}

// Returns the lights of a group in one cycle of a programme.
std::vector<Timeline<Light>::Stage> stages_of(const PhasePlan& plan, const ProgrammeSpan& span, int group) {
    const PhaseProgramme& programme = plan.programmes[span.programme];
    std::vector<Timeline<Light>::Stage> stages;
    const auto add = [&](std::int64_t ticks, Light light) {
        if (ticks > 0) stages.push_back({ticks, light});
    };
    for (int k = programme.first_phase; k <= programme.last_phase(); ++k) {
        const SignalPhase& phase = plan.phases[static_cast<std::size_t>(k)];
        const int next = k < programme.last_phase() ? k + 1 : plan.programmes[span.next_programme].first_phase;
        add(phase.green_ticks, phase.has_green(group) ? Light::green : Light::red);
        add(phase.yellow_ticks, plan.light_after(k, next, group, Light::yellow));
        add(phase.all_red_ticks, plan.light_after(k, next, group, Light::red));
    }
    return stages;
}

}  // namespace

bool has_green(const PhaseSettings& phase, const std::string& movement) {
    return contains(phase.protected_movements, movement) || contains(phase.permissive_movements, movement);
}

bool has_protected_green(const PhaseSettings& phase, const std::string& movement) {
    return contains(phase.protected_movements, movement);
}

std::vector<int> groups_with_equal_lights(const SignalSettings& settings, std::span<const std::string> movements,
                                          bool by_protection) {
    std::map<std::vector<bool>, int> group_of;  // key: green in each phase
    std::vector<int> groups;
    for (const std::string& movement : movements) {
        std::vector<bool> greens;
        for (const ProgrammeSettings& programme : phase_programmes(settings)) {
            for (const PhaseSettings& phase : programme.phases) {
                greens.push_back(has_green(phase, movement));
                if (by_protection) greens.push_back(has_protected_green(phase, movement));
            }
        }
        groups.push_back(group_of.try_emplace(greens, static_cast<int>(group_of.size())).first->second);
    }
    return groups;
}

int PhasePlan::programme_at(std::int64_t tick) const {
    const std::int64_t time = (clock_ticks + tick) % day_ticks;
    // Before the first programme of a day, the last programme of the day before is in force.
    auto programme = static_cast<int>(programmes.size()) - 1;
    for (std::size_t k = 0; k < programmes.size() && programmes[k].from_tick <= time; ++k)
        programme = static_cast<int>(k);
    return programme;
}

std::int64_t PhasePlan::next_programme_tick(std::int64_t tick) const {
    if (programmes.size() < 2) return std::numeric_limits<std::int64_t>::max();
    const std::int64_t time = (clock_ticks + tick) % day_ticks;
    for (const PhaseProgramme& programme : programmes) {
        if (programme.from_tick > time) return tick + programme.from_tick - time;
    }
    return tick + day_ticks - time + programmes.front().from_tick;
}

std::vector<ProgrammeSettings> phase_programmes(const SignalSettings& settings) {
    if (!settings.phases.empty()) return {{0.0, settings.phases}};
    return settings.programmes;
}

NominalCycle phase_cycle(const SignalSettings& settings) {
    NominalCycle nominal;
    for (const ProgrammeSettings& programme : phase_programmes(settings)) {
        nominal.cycle_s = std::max(nominal.cycle_s, programme.cycle_s());
        for (const PhaseSettings& phase : programme.phases) {
            for (const auto* names : {&phase.protected_movements, &phase.permissive_movements}) {
                for (const std::string& movement : *names) {
                    nominal.longest_green_s = std::max(nominal.longest_green_s, longest_green_s(programme, movement));
                }
            }
        }
    }
    return nominal;
}

double first_cycle_s(const SignalSettings& settings) {
    const PhasePlan plan = make_phase_plan(settings, {}, 1.0);
    return phase_programmes(settings)[static_cast<std::size_t>(plan.programme_at(0))].cycle_s();
}

double second_green_middle_s(const SignalSettings& settings) {
    if (!settings.has_phases()) return settings.stage_s(0) + 0.5 * settings.group_green_s(1);
    const std::vector<ProgrammeSettings> programmes = phase_programmes(settings);
    const std::vector<PhaseSettings>& phases = programmes.front().phases;
    const double first_s = phases.size() > 1 ? phases.front().total_s() : 0.0;
    return first_s + 0.5 * phases[phases.size() > 1 ? 1 : 0].green_s;
}

PhasePlan make_phase_plan(const SignalSettings& settings, std::span<const std::string> movements, double step_s) {
    PhasePlan plan;
    plan.day_ticks = to_ticks(kDay_s, step_s);
    plan.clock_ticks = to_ticks(settings.clock_s, step_s);
    for (const ProgrammeSettings& programme : phase_programmes(settings)) {
        PhaseProgramme added{to_ticks(programme.from_s, step_s), static_cast<int>(plan.phases.size()),
                             static_cast<int>(programme.phases.size())};
        for (const PhaseSettings& phase : programme.phases) {
            plan.phases.push_back(phase_of(phase, movements, step_s));
            added.cycle_ticks += plan.phases.back().ticks();
        }
        plan.programmes.push_back(added);
    }
    return plan;
}

PhaseTimelines make_phase_timelines(const PhasePlan& plan, int groups, std::int64_t first_tick, std::int64_t end_tick) {
    const std::vector<ProgrammeSpan> spans = programme_spans(plan, first_tick, end_tick);
    std::int64_t longest_cycle = 0;
    for (const PhaseProgramme& programme : plan.programmes)
        longest_cycle = std::max(longest_cycle, programme.cycle_ticks);
    PhaseTimelines timelines;
    std::vector<Timeline<int>::Part> phases;
    for (const ProgrammeSpan& span : spans) {
        const PhaseProgramme& programme = plan.programmes[span.programme];
        Timeline<int>::Part part{span.start_tick, {}};
        for (int k = programme.first_phase; k <= programme.last_phase(); ++k) {
            part.stages.push_back({plan.phases[static_cast<std::size_t>(k)].ticks(), k});
        }
        phases.push_back(std::move(part));
    }
    timelines.phase = Timeline<int>(-1, std::move(phases));
    for (int group = 0; group < groups; ++group) {
        std::vector<Timeline<Light>::Part> parts;
        for (const ProgrammeSpan& span : spans) parts.push_back({span.start_tick, stages_of(plan, span, group)});
        timelines.programmes.emplace_back(Timeline<Light>(Light::red, std::move(parts)), longest_cycle);
    }
    return timelines;
}

}  // namespace stopline
