// The interval at which the mesoscale mode decides which vehicles lead mini-platoons.
#pragma once

#include <algorithm>
#include <cstdint>

#include "signals/programme.h"
#include "sim/state/model.h"
#include "sim/state/state.h"

namespace stopline {

// Returns true if the step decides which vehicles lead mini-platoons: once a second, if platoons have a limit.
inline bool updates_platoons(const Model& model, const State& state) {
    constexpr double kInterval_s = 1.0;
    return model.meso && state.vehicles.has_platoon_limit &&
           state.tick % std::max<std::int64_t>(to_ticks(kInterval_s, model.step_s), 1) == 0;
}

}  // namespace stopline
