// The lights of all signals at the present tick, and the memory and detectors of the signal controllers. A SignalView
// shows a controller the part of this state that belongs to its intersection.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "signals/signal_plan.h"

namespace stopline {

// A detector on an approach lane of a signal, as the controller of this signal sees it.
struct SignalDetector {
    int number = -1;           // index of the detector in the model
    int group = 0;             // group of the signal that controls the lane
    std::uint64_t groups = 0;  // all groups that control movements of the lane; bit k: group k of the signal
    double to_line_m = 0.0;    // distance from the detector to the stop line
    bool is_occupied = false;  // a vehicle covers a part of the detector
    // Tick at the end of the step in which a front passed the detector last; -1: never.
    std::int64_t last_crossing_tick = -1;
    std::int64_t last_occupied_tick = -1;  // last tick at which a vehicle covered the detector; -1: never
    // Only for detectors of SignalPlan::lane_detectors: the phases that this detector calls and extends; bit k: phase
    // k.
    std::uint64_t phases = 0;
    // Only if the controller hears platoons: the first platoon of the lane that can still stop if green ends now
    // (sim/junction/lights/announced_platoon.h). The tick at which its rear passes the line; -1: no platoon.
    std::int64_t platoon_rear_tick = -1;
    bool platoon_can_wait = true;  // the whole platoon can still wait for the next green
};

// State::signals. Ticks count from the start of the run. A light that began before the run has a start tick below 0.
struct SignalState {
    std::vector<Light> lights;                      // [signal group] light at the present tick
    std::vector<std::int64_t> since_tick;           // [signal group] tick at which the present light began
    std::vector<std::int64_t> green_start_tick;     // [signal group] start of the latest green, or kNoGreen
    std::vector<int> phase;                         // [signal] phase whose green began last; -1: none, or no phases
    std::vector<std::int64_t> phase_start_tick;     // [signal] tick at which this green began
    std::int64_t last_phase_start_tick = -1;        // the latest of phase_start_tick; -1: no phase has begun
    std::vector<std::int64_t> next_step_tick;       // [signal] tick at which the controller decides next
    std::int64_t first_step_tick = 0;               // the earliest of next_step_tick
    std::vector<std::vector<std::int64_t>> memory;  // [signal] numbers that the controller keeps
    // [signal] Detectors on the lanes of the signal. Empty for controllers that do not read them.
    std::vector<std::vector<SignalDetector>> detectors;
};

// A green of a signal group: the ticks from `from_tick` to before `until_tick`.
struct GreenWindow {
    static constexpr std::int64_t kUnknown = std::numeric_limits<std::int64_t>::max();
    std::int64_t from_tick = kUnknown;
    std::int64_t until_tick = kUnknown;
    bool is_known() const { return from_tick != kUnknown; }
};

// SignalView is what a controller may read and write: the lights, the memory and the detectors of one intersection at
// one tick.
class SignalView {
public:
    SignalView(const SignalPlan& plan, std::size_t signal, std::int64_t tick, SignalState& state)
        : plan_(plan), signal_(signal), tick_(tick), state_(state) {}

    const SignalPlan& plan() const { return plan_; }
    std::int64_t tick() const { return tick_; }
    int groups() const { return static_cast<int>(plan_.groups.size()); }
    Light light(int group) const { return state_.lights[index(group)]; }
    std::int64_t since_tick(int group) const { return state_.since_tick[index(group)]; }
    std::int64_t green_start_tick(int group) const { return state_.green_start_tick[index(group)]; }
    std::span<const SignalDetector> detectors() const { return state_.detectors[signal_]; }
    std::span<std::int64_t> memory() { return state_.memory[signal_]; }

    // Shows a light from the present tick on. Does nothing if the group already shows this light.
    void show(int group, Light light) {
        if (light == this->light(group)) return;
        state_.lights[index(group)] = light;
        state_.since_tick[index(group)] = tick_;
        if (light == Light::green) state_.green_start_tick[index(group)] = tick_;
    }
    // Begins the green of a phase of SignalPlan::phases at the present tick. Right of way changes with it. The caller
    // also shows the lights.
    void begin_phase(int phase) {
        state_.phase[signal_] = phase;
        state_.phase_start_tick[signal_] = tick_;
        state_.last_phase_start_tick = tick_;
    }
    // Sets the light with which a run begins. `since_tick` may be below 0. `green_start_tick`: start of the latest
    // green, or kNoGreen.
    void begin_with(int group, Light light, std::int64_t since_tick, std::int64_t green_start_tick) {
        state_.lights[index(group)] = light;
        state_.since_tick[index(group)] = since_tick;
        state_.green_start_tick[index(group)] = green_start_tick;
    }

private:
    std::size_t index(int group) const {
        return static_cast<std::size_t>(plan_.groups[static_cast<std::size_t>(group)]);
    }

    const SignalPlan& plan_;
    std::size_t signal_;
    std::int64_t tick_;
    SignalState& state_;
};

}  // namespace stopline
