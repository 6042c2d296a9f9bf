// The list of signal controllers.
#include <algorithm>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "base/defined_elsewhere.h"
#include "base/input_error.h"
#include "signals/signal_controller.h"

namespace stopline {

// Returns the controllers. The order is the order in lists for the user.
static std::vector<const SignalController*>& controllers() {
    static std::vector<const SignalController*> all{
        // NOLINTBEGIN(readability-identifier-naming): the macro declares constants of the namespace inside a function.
        STOPLINE_DEFINED_ELSEWHERE(SignalController, kFixedTimeController),
        STOPLINE_DEFINED_ELSEWHERE(SignalController, kActuatedController),
        STOPLINE_DEFINED_ELSEWHERE(SignalController, kDualRingController),
        STOPLINE_DEFINED_ELSEWHERE(SignalController, kExternalController),
        // NOLINTEND(readability-identifier-naming)
    };
    return all;
}

std::span<const SignalController* const> signal_controllers() { return controllers(); }

void register_signal_controller(const SignalController& controller) { controllers().push_back(&controller); }

std::vector<std::string> signal_controller_names() {
    std::vector<std::string> names;
    for (const SignalController* controller : controllers()) names.emplace_back(controller->name);
    return names;
}

const SignalController& find_signal_controller(std::string_view name) {
    for (const SignalController* controller : controllers()) {
        if (name == controller->name) return *controller;
    }
    throw InputError(fmt::format("there is no signal controller '{}'; the controllers are: {}", name,
                                 fmt::join(signal_controller_names(), ", ")));
}

std::vector<SignalParameter> signal_parameters() {
    std::vector<SignalParameter> all;
    for (const SignalController* controller : controllers()) {
        for (const SignalParameter& parameter : controller->parameters) {
            const auto has_name = [&](const SignalParameter& one) {
                return std::string_view(one.name) == parameter.name;
            };
            if (std::none_of(all.begin(), all.end(), has_name)) all.push_back(parameter);
        }
    }
    if (all.size() > kMaxSignalParameters) throw std::logic_error("more parameters than kMaxSignalParameters");
    return all;
}

double signal_parameter(const SignalSettings& settings, std::string_view name) {
    const std::vector<SignalParameter> all = signal_parameters();
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (name == all[k].name) return settings.parameters[k];
    }
    throw std::logic_error(fmt::format("no signal controller has the parameter '{}'", name));
}

NominalCycle nominal_cycle(const SignalSettings& settings, int groups) {
    return find_signal_controller(settings.controller).nominal_cycle(settings, groups);
}

void SignalPlans::add(SignalPlan plan) {
    for (std::size_t k = 0; k < plan.groups.size(); ++k) {
        const auto group = static_cast<std::size_t>(plan.groups[k]);
        if (group >= places_.size()) places_.resize(group + 1);
        places_[group] = {plans_.size(), k, true};
    }
    plans_.push_back(std::move(plan));
}

bool SignalPlans::never_changes(int group) const {
    return plan_of(group).controller->follows_programme && programme(group).never_changes();
}

bool SignalPlans::is_complete() const {
    return std::all_of(places_.begin(), places_.end(), [](const Place& place) { return place.is_known; });
}

SignalPlan fixed_time_plan(int first_group, std::vector<GroupProgramme> programmes) {
    std::vector<int> groups;
    for (std::size_t k = 0; k < programmes.size(); ++k) groups.push_back(first_group + static_cast<int>(k));
    return fixed_time_plan(std::move(groups), std::move(programmes));
}

SignalPlan fixed_time_plan(std::vector<int> groups, std::vector<GroupProgramme> programmes) {
    SignalPlan plan;
    // NOLINTNEXTLINE(readability-identifier-naming)
    plan.controller = STOPLINE_DEFINED_ELSEWHERE(SignalController, kFixedTimeController);
    plan.groups = std::move(groups);
    plan.nominal_cycle_ticks = programmes.at(0).cycle_ticks();
    plan.programmes = std::move(programmes);
    return plan;
}

SignalPlan make_phase_signal_plan(const SignalSettings& settings, int first_group,
                                  std::span<const std::string> movements, double step_s, std::int64_t end_tick) {
    PhasePlan phases = make_phase_plan(settings, movements, step_s);
    if (find_signal_controller(settings.controller).runs_rings) {
        phases.rings = make_ring_plan(settings, movements, step_s);
        SignalPlan plan = make_signal_plan(settings, first_group,
                                           make_ring_programmes(phases, static_cast<int>(movements.size())), step_s);
        plan.phases = std::move(phases);
        return plan;
    }
    PhaseTimelines timelines = make_phase_timelines(phases, static_cast<int>(movements.size()),
                                                    to_ticks(settings.first_green_s, step_s), end_tick);
    SignalPlan plan = make_signal_plan(settings, first_group, std::move(timelines.programmes), step_s);
    plan.phases = std::move(phases);
    plan.phase_at = std::move(timelines.phase);
    return plan;
}

SignalPlan make_signal_plan(const SignalSettings& settings, int first_group, std::vector<GroupProgramme> programmes,
                            double step_s) {
    SignalPlan plan = fixed_time_plan(first_group, std::move(programmes));
    plan.controller = &find_signal_controller(settings.controller);
    plan.settings = settings;
    plan.step_s = step_s;
    for (const SignalParameter& parameter : plan.controller->parameters) {
        plan.values.push_back(signal_parameter(settings, parameter.name));
    }
    if (plan.controller->follows_programme) return plan;
    const NominalCycle nominal = plan.controller->nominal_cycle(settings, static_cast<int>(plan.groups.size()));
    plan.nominal_cycle_ticks = to_ticks(nominal.cycle_s, step_s);
    return plan;
}

}  // namespace stopline
