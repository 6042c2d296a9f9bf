// The fixed-time controller: each group follows its programme.
#include <algorithm>
#include <limits>

#include "signals/signal_controller.h"

namespace stopline {

namespace {

NominalCycle nominal_cycle_of(const SignalSettings& settings, int groups) {
    if (settings.has_phases()) return phase_cycle(settings);
    if (groups == 1) return {settings.cycle_s, settings.green_s};
    return {settings.intersection_cycle_s(), std::max(settings.group_green_s(0), settings.group_green_s(1))};
}

std::int64_t next_change_tick(const SignalView& view) {
    std::int64_t next_tick = std::numeric_limits<std::int64_t>::max();
    if (!view.plan().phases.empty()) next_tick = view.plan().phase_at.next_change_tick(view.tick());
    for (const GroupProgramme& programme : view.plan().programmes) {
        next_tick = std::min(next_tick, programme.next_change_tick(view.tick()));
    }
    return next_tick;
}

// Begins the phase that starts at the present tick, if there is one.
void begin_phase(SignalView& view) {
    if (view.plan().phases.empty()) return;
    const Timeline<int>& phases = view.plan().phase_at;
    if (phases.at(view.tick()) >= 0 && phases.start_tick(view.tick()) == view.tick())
        view.begin_phase(phases.at(view.tick()));
}

std::int64_t init(SignalView& view) {
    for (int group = 0; group < view.groups(); ++group) {
        const GroupProgramme& programme = view.plan().programmes[static_cast<std::size_t>(group)];
        view.begin_with(group, programme.light(view.tick()), programme.light_start_tick(view.tick()),
                        programme.last_green_start_tick(view.tick()));
    }
    begin_phase(view);
    return next_change_tick(view);
}

std::int64_t step(SignalView& view) {
    for (int group = 0; group < view.groups(); ++group) {
        view.show(group, view.plan().programmes[static_cast<std::size_t>(group)].light(view.tick()));
    }
    begin_phase(view);
    return next_change_tick(view);
}

// Returns the first green that ends after the tick. Returns an unknown window if the group gets no green.
GreenWindow next_green(const SignalView& view, int group, std::int64_t after_tick) {
    constexpr int kMostChanges = 100;  // limits the search for groups that never get green
    const GroupProgramme& programme = view.plan().programmes[static_cast<std::size_t>(group)];
    std::int64_t tick = after_tick;
    for (int k = 0; k < kMostChanges && programme.light(tick) != Light::green; ++k) {
        tick = programme.next_change_tick(tick);
        if (tick == GreenWindow::kUnknown) return {};
    }
    if (programme.light(tick) != Light::green) return {};
    GreenWindow green{programme.light_start_tick(tick), tick};
    for (int k = 0; k < kMostChanges && programme.light(green.until_tick) == Light::green; ++k) {
        green.until_tick = programme.next_change_tick(green.until_tick);
        if (green.until_tick == GreenWindow::kUnknown) break;
    }
    return green;
}

}  // namespace

extern const SignalController kFixedTimeController{
    .name = "fixed_time",
    .meaning = "the lights follow a programme and do not depend on the traffic",
    .parameters = {},
    .nominal_cycle = nominal_cycle_of,
    .init = init,
    .step = step,
    .next_green = next_green,
    .follows_programme = true,
    .runs_phases = true};

}  // namespace stopline
