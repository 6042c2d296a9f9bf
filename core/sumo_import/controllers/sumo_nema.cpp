// Signals of the type `NEMA`, which become signals with the controller `dual_ring`.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "base/input_error.h"
#include "signals/rings/ring_plan.h"
#include "signals/rings/ring_problems.h"
#include "sumo_import/controllers/sumo_controller.h"

namespace stopline {

namespace {

constexpr std::size_t kMaxRingPhases = 9;         // the digits from 1 to 9 name the phases
constexpr double kLongestNominalGreen_s = 600.0;  // without maxDur there is no maximum green

// Returns the phase numbers in the value of a parameter. SUMO reads each digit as a number. 0 stands for no phase.
std::vector<int> numbers_of(const SumoSignal& signal, const std::string& name, const std::string& fallback = "") {
    const auto found = signal.parameters.find(name);
    std::vector<int> numbers;
    for (const char c : found == signal.parameters.end() ? fallback : found->second) {
        if (c > '0' && c <= '9') numbers.push_back(c - '0');
    }
    return numbers;
}

bool is_true(const SumoSignal& signal, const std::string& name) {
    const auto found = signal.parameters.find(name);
    return found != signal.parameters.end() && (found->second == "true" || found->second == "1");
}

bool contains_number(const std::vector<int>& numbers, int number) {
    return std::find(numbers.begin(), numbers.end(), number) != numbers.end();
}

const SumoPhase& phase_with(const SumoSignal& signal, int number) {
    for (const SumoPhase& phase : signal.phases) {
        if (phase.name == std::to_string(number)) return phase;
    }
    throw InputError(
        fmt::format("{}: the rings name the phase {}, but no phase has name=\"{}\"", signal.where, number, number));
}

// Adds the phases of a ring. Its first side ends with the first phase that is a barrier phase or a coordinated one.
void add_ring(const SumoSignal& signal, int ring, const std::vector<int>& numbers, const std::vector<int>& last_phases,
              SumoController& controller) {
    const std::vector<int> minimum = numbers_of(signal, "minRecall", "1,2,3,4,5,6,7,8");
    const std::vector<int> maximum = numbers_of(signal, "maxRecall");
    const std::vector<int> coordinated = numbers_of(signal, "coordinatePhases");
    int barrier = 1;
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        const SumoPhase& from = phase_with(signal, numbers[k]);
        const bool is_last = contains_number(last_phases, numbers[k]);
        PhaseSettings phase;
        phase.ring = ring;
        phase.barrier = barrier;
        phase.max_green_s = std::max(from.max_s, from.min_s);
        phase.green_s = std::min(phase.max_green_s, kLongestNominalGreen_s);
        phase.min_green_s = from.min_s;
        phase.gap_s = from.extension_s;
        phase.yellow_s = from.yellow_s;
        phase.all_red_s = from.red_s;
        if (contains_number(minimum, numbers[k])) phase.recall = "minimum";
        if (contains_number(maximum, numbers[k])) phase.recall = "maximum";
        if (contains_number(coordinated, numbers[k]) && controller.settings.cycle_s > 0.0) phase.coordinated = "on";
        // A ring without a call shows the last phase of its side.
        if ((is_last && barrier == 1) || k + 1 == numbers.size()) phase.dual_entry = "on";
        if (is_last) barrier = 2;
        controller.settings.phases.push_back(phase);
        controller.states.push_back(from.state);
    }
}

std::string combined(const std::string& first, const std::string& second) {
    std::string state = first;
    for (std::size_t k = 0; k < state.size(); ++k) {
        if (second[k] == 'G' || (second[k] == 'g' && state[k] != 'G')) state[k] = second[k];
    }
    return state;
}

// Replaces the phases by all pairs, in the order of RingPlan::pairs. Their durations add up to the cycle.
void set_pairs(SumoSignal& signal, SumoController& controller) {
    const RingPlan rings = make_ring_plan(controller.settings, {}, 1.0);
    const double cycle_s =
        controller.settings.cycle_s > 0.0 ? controller.settings.cycle_s : ring_cycle_s(controller.settings);
    std::vector<SumoPhase> phases;
    for (const RingPair& pair : rings.pairs) {
        std::string state(signal.phases[0].state.size(), 'r');
        for (const int k : pair.phase) {
            if (k >= 0) state = combined(state, controller.states[at(k)]);
        }
        controller.sumo_phases.push_back(static_cast<int>(phases.size()));
        phases.push_back({cycle_s / static_cast<double>(rings.pairs.size()), state});
    }
    signal.phases = std::move(phases);
}

// Returns the start of the background cycle. SUMO's cycle begins with the end of the coordinated phase and its
// clearance (cabinetType Type170), or with its green (TS2).
double cycle_start_s(const SumoSignal& signal, const SumoController& controller) {
    constexpr double kTick_s = 1e-3;
    const RingPlan rings = make_ring_plan(controller.settings, {}, kTick_s);
    const int number = rings.coordinated[0] >= 0 ? rings.coordinated[0] : rings.coordinated[1];
    if (number < 0) return 0.0;
    const auto cabinet = signal.parameters.find("cabinetType");
    const double start_s = static_cast<double>(rings.phases[at(number)].start_point) * kTick_s;
    const bool begins_with_green = cabinet != signal.parameters.end() && cabinet->second == "TS2";
    const double point_s = begins_with_green ? start_s : start_s + controller.settings.phases[at(number)].total_s();
    return signal.offset_s - point_s;
}

}  // namespace

void set_nema_controller(SumoSignal& signal, SumoWarnings& warnings) {
    auto controller = std::make_shared<SumoController>();
    controller->settings.controller = "dual_ring";
    controller->settings.first_green_s = 0.0;
    if (is_true(signal, "coordinate-mode")) {
        controller->settings.cycle_s =
            sumo_parameter(signal, "total-cycle-length",
                           sumo_parameter(signal, "cycle-length", sumo_parameter(signal, "cycleTime", 60.0)));
    }
    const std::vector<int> barriers = numbers_of(signal, "barrierPhases");
    std::vector<int> last_phases = numbers_of(signal, "coordinatePhases");
    for (const int number : numbers_of(signal, "barrier2Phases")) last_phases.push_back(number);
    last_phases.insert(last_phases.end(), barriers.begin(), barriers.end());
    const std::vector<int> first_ring = numbers_of(signal, "ring1");
    const std::vector<int> second_ring = numbers_of(signal, "ring2");
    if (std::max(first_ring.size(), second_ring.size()) > kMaxRingPhases) {
        warnings.note(signal.where, fmt::format("the rings of the signal '{}' are not supported: a ring has more than "
                                                "{} phases",
                                                signal.id, kMaxRingPhases));
        return;
    }
    add_ring(signal, 1, first_ring, last_phases, *controller);
    add_ring(signal, 2, second_ring, last_phases, *controller);
    SignalSettings checked = controller->settings;
    for (PhaseSettings& phase : checked.phases) phase.protected_movements = {"any"};
    for (const SignalProblem& problem : ring_problems(checked, 0)) {
        warnings.note(signal.where, fmt::format("the rings of the signal '{}' are not supported: {}: {}", signal.id,
                                                problem.field, problem.message));
        return;
    }
    controller->cycle_start_s = cycle_start_s(signal, *controller);
    if (is_true(signal, "fixForceOff"))
        warnings.note(signal.where,
                      "'fixForceOff' is ignored: the time that a phase leaves goes to coordinated phases");
    note_unknown_parameters(
        signal,
        {"ring1", "ring2", "barrierPhases", "barrier2Phases", "coordinatePhases", "minRecall", "maxRecall",
         "coordinate-mode", "total-cycle-length", "cycle-length", "cycleTime", "detector-length", "cabinetType",
         "fixForceOff", "show-detectors", "whetherOutputState", "file", "freq", "ignore-errors"},
        warnings);
    set_pairs(signal, *controller);
    signal.controller = std::move(controller);
}

}  // namespace stopline
