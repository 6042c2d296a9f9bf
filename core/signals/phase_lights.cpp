#include "signals/phase_lights.h"

namespace stopline {

void show_phase(SignalView& view, int phase) {
    const SignalPhase& shown = view.plan().phases.phases[static_cast<std::size_t>(phase)];
    for (int group = 0; group < view.groups(); ++group) {
        view.show(group, shown.has_green(group) ? Light::green : Light::red);
    }
    view.begin_phase(phase);
}

void show_red_after_yellow(SignalView& view) {
    for (int group = 0; group < view.groups(); ++group) {
        if (view.light(group) == Light::yellow) view.show(group, Light::red);
    }
}

}  // namespace stopline
