// The lights of a signal whose phases run one at a time.
#pragma once

#include "signals/signal_state.h"

namespace stopline {

// Begins the green of a phase: shows its green, and red for all other groups.
void show_phase(SignalView& view, int phase);

// Shows the light of each green group after the green of phase `present`, if phase `next` follows: yellow, or green if
// the group keeps it. Calls `on_end(group)` for each group that loses green.
template <class OnEnd>
void show_yellow(SignalView& view, int present, int next, OnEnd on_end) {
    for (int group = 0; group < view.groups(); ++group) {
        if (view.light(group) != Light::green) continue;
        const Light light = view.plan().phases.light_after(present, next, group, Light::yellow);
        view.show(group, light);
        if (light != Light::green) on_end(group);
    }
}

// Shows red for all yellow groups.
void show_red_after_yellow(SignalView& view);

}  // namespace stopline
