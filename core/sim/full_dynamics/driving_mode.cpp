#include "sim/full_dynamics/driving_mode.h"

#include <algorithm>

#include "v2v/fallback.h"

namespace stopline {

namespace {

// Returns the mode that an age demands.
int demanded_mode(const V2vPlan& plan, int age_ticks) {
    int mode = 0;
    for (const int longest_ticks : plan.longest_age_ticks) mode += age_ticks > longest_ticks ? 1 : 0;
    return mode;
}

}  // namespace

int update_driving_mode(const V2vPlan& plan, int tick, const AgeOfMessages& before, const AgeOfMessages& now, int& mode,
                        V2vModeMemory& memory) {
    // If the age of the previous step still demanded the present mode, the hysteresis begins again at that step.
    if (before.has_leader && demanded_mode(plan, tick - 1 - before.sent_tick) == mode) {
        memory.worst = 0;
        memory.since_tick = tick - 1;
    }
    if (!now.has_leader) return kNeverDue;
    const int demanded = demanded_mode(plan, tick - now.sent_tick);
    FallbackModeOf<double> fallback{static_cast<double>(mode), static_cast<double>(memory.worst),
                                    static_cast<double>(tick - memory.since_tick)};
    update_mode(fallback, static_cast<double>(demanded), plan.hysteresis_ticks);
    mode = static_cast<int>(fallback.mode);
    memory.worst = static_cast<int>(fallback.worst);
    memory.since_tick = tick - static_cast<int>(fallback.ticks);
    int next = kNeverDue;
    const auto limit = static_cast<std::size_t>(demanded);
    if (limit < plan.longest_age_ticks.size()) next = now.sent_tick + plan.longest_age_ticks[limit] + 1;
    if (demanded < mode) next = std::min(next, memory.since_tick + plan.hysteresis_ticks);
    return next;
}

}  // namespace stopline
