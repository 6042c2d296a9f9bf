// Signals of the type `actuated`. Green phases become phases of the controller `actuated`. The phases between them
// become its yellow and all-red times.
#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

#include "base/containers/index.h"
#include "sumo_import/controllers/sumo_controller.h"

namespace stopline {

namespace {

constexpr std::size_t kMaxPhases = 64;  // bits of LaneDetector::phases

bool has_yellow(const SumoPhase& phase) { return phase.state.find_first_of("yY") != std::string::npos; }
bool is_green_phase(const SumoPhase& phase) {
    return phase.state.find_first_of("gG") != std::string::npos && !has_yellow(phase);
}

// Returns the phases in the order in which they run, from the first green phase on. The list is empty if the phases
// that run do not repeat with it.
std::vector<int> order_of(const SumoSignal& signal, SumoWarnings& warnings) {
    const auto count = static_cast<int>(signal.phases.size());
    const auto first = std::find_if(signal.phases.begin(), signal.phases.end(), is_green_phase);
    std::vector<int> order;
    auto phase = static_cast<int>(first - signal.phases.begin());
    while (phase < count && std::find(order.begin(), order.end(), phase) == order.end()) {
        order.push_back(phase);
        const std::vector<int>& next = signal.phases[at(phase)].next;
        if (next.size() > 1)
            warnings.note(signal.where, "'next' with several phases: only the first of them can follow");
        phase = next.empty() ? (phase + 1) % count : next.front();
    }
    if (phase >= count || order.empty() || phase != order.front()) return {};
    return order;
}

// Returns true if the phases between two green phases show what the controller shows there: yellow, then red for links
// that lose green, green for links that keep it, and red for all others. Sets the times of yellow and red.
bool is_clearance(const SumoSignal& signal, const std::vector<int>& order, std::size_t green, std::size_t past,
                  PhaseSettings& settings) {
    const std::string& before = signal.phases[at(order[green])].state;
    const std::string& after = signal.phases[at(order[past % order.size()])].state;
    settings.yellow_s = settings.all_red_s = 0.0;
    for (std::size_t k = green + 1; k < past; ++k) {
        const SumoPhase& phase = signal.phases[at(order[k])];
        const bool is_yellow = has_yellow(phase);
        if (is_yellow && settings.all_red_s > 0.0) return false;
        (is_yellow ? settings.yellow_s : settings.all_red_s) += phase.duration_s;
        for (std::size_t link = 0; link < phase.state.size(); ++link) {
            const bool keeps = sumo_is_green(before[link]) && sumo_is_green(after[link]);
            const bool loses = sumo_is_green(before[link]) && !keeps;
            const char letter = phase.state[link];
            const bool shows_yellow = letter == 'y' || letter == 'Y';
            if (keeps != sumo_is_green(letter) || (loses && is_yellow) != shows_yellow) return false;
        }
    }
    return true;
}

}  // namespace

void set_actuated_controller(SumoSignal& signal, SumoWarnings& warnings) {
    const std::vector<int> order = order_of(signal, warnings);
    auto controller = std::make_shared<SumoController>();
    controller->settings.controller = "actuated";
    controller->settings.first_green_s = 0.0;
    for (std::size_t k = 0; k < order.size();) {
        std::size_t past = k + 1;
        while (past < order.size() && !is_green_phase(signal.phases[at(order[past])])) ++past;
        const SumoPhase& phase = signal.phases[at(order[k])];
        PhaseSettings settings;
        settings.green_s = phase.duration_s;
        settings.min_green_s = phase.min_s;
        settings.max_green_s = std::max(phase.min_s, phase.max_s);
        settings.gap_s = sumo_parameter(signal, "max-gap", 3.0);
        settings.recall = "minimum";  // no phase is skipped
        if (!is_clearance(signal, order, k, past, settings)) {
            warnings.note(signal.where,
                          fmt::format("the phases between two greens of the actuated signal '{}' are not yellow, then "
                                      "red, for the links that lose green",
                                      signal.id));
            return;
        }
        controller->settings.phases.push_back(settings);
        controller->states.push_back(phase.state);
        controller->sumo_phases.push_back(order[k]);
        k = past;
    }
    const auto is_fixed = [](const PhaseSettings& phase) { return phase.min_green_s >= phase.max_green_s; };
    const auto& phases = controller->settings.phases;
    if (std::all_of(phases.begin(), phases.end(), is_fixed)) return;
    if (controller->states.size() < 2 || controller->states.size() > kMaxPhases) return;
    if (signal.offset_s != 0.0) warnings.note(signal.where, "'offset' of actuated signals is ignored");
    note_unknown_parameters(signal,
                            {"max-gap", "detector-gap", "passing-time", "show-detectors", "file", "freq",
                             "inactive-threshold", "show-conditions", "hide-conditions"},
                            warnings);
    for (const auto& [name, value] : signal.parameters) {
        if (name.starts_with("max-gap:")) warnings.note(signal.where, "the parameter 'max-gap:LANE' is ignored");
    }
    signal.controller = std::move(controller);
}

}  // namespace stopline
