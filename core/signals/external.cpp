#include "signals/external.h"

#include <stdexcept>

#include <fmt/format.h>

#include "signals/phase_lights.h"
#include "signals/signal_controller.h"

namespace stopline {

namespace {

enum class ExternalInterval : std::uint8_t { initial_red, green, yellow, all_red };

// Indices in the memory of the controller. kWantedPhase: the phase that the program asked for last.
constexpr std::size_t kWantedPhase = 0;
constexpr std::size_t kPresentPhase = 1;
constexpr std::size_t kComingPhase = 2;
constexpr std::size_t kPresentInterval = 3;
constexpr std::size_t kIntervalTick = 4;
constexpr std::size_t kExternalNumbers = 5;

class ExternalSignal {
public:
    explicit ExternalSignal(SignalView& view) : view_(view), memory_(view.memory()) {}

    // Sets the lights of the present tick.
    void step() {
        const std::int64_t elapsed = view_.tick() - memory_[kIntervalTick];
        switch (static_cast<ExternalInterval>(memory_[kPresentInterval])) {
            case ExternalInterval::initial_red:
                return begin_green(memory_[kWantedPhase]);
            case ExternalInterval::green:
                if (memory_[kWantedPhase] != memory_[kPresentPhase] && elapsed >= shortest_green()) begin_yellow();
                return;
            case ExternalInterval::yellow:
                if (elapsed >= present().yellow_ticks) begin_all_red();
                return;
            case ExternalInterval::all_red:
                if (elapsed >= present().all_red_ticks) begin_green(memory_[kComingPhase]);
                return;
        }
    }

private:
    const SignalPhase& present() const {
        return view_.plan().phases.phases[static_cast<std::size_t>(memory_[kPresentPhase])];
    }
    // Pedestrian phases, which give green to no movement, last for their green.
    std::int64_t shortest_green() const {
        return present().green_groups == 0 ? present().green_ticks : present().min_green_ticks;
    }
    void begin(ExternalInterval interval) {
        memory_[kPresentInterval] = static_cast<std::int64_t>(interval);
        memory_[kIntervalTick] = view_.tick();
    }
    void begin_green(std::int64_t phase) {
        begin(ExternalInterval::green);
        memory_[kPresentPhase] = phase;
        show_phase(view_, static_cast<int>(phase));
    }
    void begin_yellow() {
        begin(ExternalInterval::yellow);
        memory_[kComingPhase] = memory_[kWantedPhase];
        show_yellow(view_, static_cast<int>(memory_[kPresentPhase]), static_cast<int>(memory_[kComingPhase]),
                    [](int /*group*/) {});
        if (present().yellow_ticks == 0) begin_all_red();
    }
    void begin_all_red() {
        begin(ExternalInterval::all_red);
        show_red_after_yellow(view_);
        if (present().all_red_ticks == 0) begin_green(memory_[kComingPhase]);
    }

    SignalView& view_;
    std::span<std::int64_t> memory_;
};

std::int64_t start_external(SignalView& view) {
    const std::int64_t first_tick = to_ticks(view.plan().settings.first_green_s, view.plan().step_s);
    if (first_tick > view.tick()) return first_tick;
    ExternalSignal(view).step();
    return view.tick() + 1;
}

std::int64_t step_external(SignalView& view) {
    ExternalSignal(view).step();
    return view.tick() + 1;
}

NominalCycle external_cycle(const SignalSettings& settings, int /*groups*/) {
    if (settings.has_phases()) return phase_cycle(settings);
    return {settings.intersection_cycle_s(), settings.green_s};  // the settings are refused
}

std::vector<SignalProblem> external_problems(const SignalSettings& settings, int /*groups*/) {
    if (settings.has_phases()) return {};
    return {{"controller", "'external' needs signal.phases or signal.programmes"}};
}

}  // namespace

void request_phase(const SignalPlan& plan, std::size_t signal, int phase, SignalState& signals) {
    if (plan.controller != &find_signal_controller("external"))
        throw std::invalid_argument("the signal does not have the controller 'external'");
    const std::size_t phases = plan.phases.phases.size();
    if (phase < 0 || static_cast<std::size_t>(phase) >= phases)
        throw std::invalid_argument(
            fmt::format("phase {} does not exist; the signal has the phases 0 to {}", phase, phases - 1));
    signals.memory[signal][kWantedPhase] = phase;
}

extern const SignalController kExternalController{
    .name = "external",
    .meaning = "your Python code chooses the phases; without a request, the first phase stays green",
    .parameters = {},
    .nominal_cycle = external_cycle,
    .init = start_external,
    .step = step_external,
    .memory_size = [](const SignalPlan& /*plan*/) { return kExternalNumbers; },
    .problems = external_problems,
    .runs_phases = true};

}  // namespace stopline
