#include "runs/hcm/signal_cycles.h"

#include <algorithm>

#include "base/containers/index.h"
#include "signals/signal_controller.h"

namespace stopline {

namespace {

// Returns true if the rings begin a new cycle with the pair of phases `next`: they have come back to an earlier side of
// the barriers, or begin the same side again.
bool begins_ring_cycle(const RingPlan& rings, int previous, int next) {
    const RingPair& before = rings.pairs[at(previous)];
    const RingPair& now = rings.pairs[at(next)];
    const auto side = [&](const RingPair& pair) {
        return rings.phases[at(std::max(pair.phase[0], pair.phase[1]))].side;
    };
    if (side(now) != side(before)) return side(now) < side(before);
    if (now == before) return true;
    for (std::size_t ring = 0; ring < kRings; ++ring) {
        if (before.phase[ring] < 0 || now.phase[ring] < 0) continue;
        if (rings.phases[at(now.phase[ring])].place < rings.phases[at(before.phase[ring])].place) return true;
    }
    return false;
}

// Returns true if a signal begins a new cycle with the green of the phase `next`. `previous`: the phase before it.
bool begins_cycle(const SignalPlan& plan, int previous, int next) {
    if (plan.controller->runs_rings) return begins_ring_cycle(plan.phases.rings, previous, next);
    const auto is_after_previous = [&](const PhaseProgramme& programme) { return programme.first_phase > previous; };
    const std::vector<PhaseProgramme>& programmes = plan.phases.programmes;
    const auto later = std::find_if(programmes.begin(), programmes.end(), is_after_previous);
    const bool is_later_programme = later != programmes.end() && next >= later->first_phase;
    return next <= previous || is_later_programme;
}

int greens_per_cycle(const GroupProgramme& programme) {
    const std::int64_t last_tick = programme.first_tick() + programme.cycle_ticks();
    int greens = 0;
    for (std::int64_t tick = programme.next_change_tick(programme.first_tick()); tick <= last_tick;
         tick = programme.next_change_tick(tick)) {
        greens += programme.light(tick) == Light::green ? 1 : 0;
    }
    return greens;
}

// Returns the number of the cycle of a programme at a tick. The programme must have begun.
std::int64_t programme_cycle(const GroupProgramme& programme, std::int64_t tick) {
    return (tick - programme.first_tick()) / programme.cycle_ticks();
}

}  // namespace

SignalCycles::SignalCycles(const Model& model)
    : model_(model), signals_(model.signals.size()), greens_can_vary_(at(model.signals.groups())) {
    for (int group = 0; group < model.signals.groups(); ++group) {
        if (!model.signals.place_of(group).is_known) continue;
        const SignalPlan& plan = model.signals.plan_of(group);
        const bool is_fixed = plan.controller->follows_programme && plan.phases.programmes.size() <= 1;
        greens_can_vary_[at(group)] = !is_fixed || greens_per_cycle(model.signals.programme(group)) != 1;
    }
}

std::int64_t SignalCycles::number(int group) const {
    return greens_can_vary_[at(group)] ? signals_[model_.signals.place_of(group).signal].number : kNoCycle;
}

std::int64_t SignalCycles::start_tick(int group) const {
    return signals_[model_.signals.place_of(group).signal].start_tick;
}

void SignalCycles::update(const State& state) {
    for (std::size_t k = 0; k < signals_.size(); ++k) {
        const SignalPlan& plan = model_.signals[k];
        Signal& signal = signals_[k];
        const int phase = state.signals.phase[k];
        if (phase >= 0) {
            const std::int64_t start_tick = state.signals.phase_start_tick[k];
            const bool is_first = signal.phase < 0;
            const bool has_begun = !is_first && start_tick != signal.phase_start_tick;
            if (is_first || (has_begun && begins_cycle(plan, signal.phase, phase))) {
                ++signal.number;
                signal.start_tick = start_tick;
            }
            signal.phase = phase;
            signal.phase_start_tick = start_tick;
        } else if (plan.controller->follows_programme && plan.phases.empty()) {
            const GroupProgramme& programme = plan.programmes.front();
            if (state.tick < programme.first_tick()) continue;
            signal.number = programme_cycle(programme, state.tick);
            signal.start_tick = programme.first_tick() + signal.number * programme.cycle_ticks();
        }
    }
}

}  // namespace stopline
