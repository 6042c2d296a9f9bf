#include "sumo_import/sumo_signals.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "signals/signal_controller.h"
#include "sumo_import/controllers/sumo_controller.h"

namespace stopline {

namespace {

Light light_of(char letter) {
    if (sumo_is_green(letter)) return Light::green;
    return letter == 'y' || letter == 'Y' ? Light::yellow : Light::red;
}

// Returns the offset of a signal, reduced to less than one cycle, in ticks.
std::int64_t offset_ticks(const SumoSignal& signal, double step_s) {
    return to_ticks(std::fmod(signal.offset_s, signal.cycle_s()), step_s);
}

// Returns the programme of one link. The function rounds the end times of phases to ticks, not the durations, so
// rounding errors do not add up. Consecutive phases with the same light become one stage.
GroupProgramme programme_of(const SumoSignal& signal, int link, double step_s) {
    std::vector<Stage> stages;
    double end_s = 0.0;
    std::int64_t begin = 0;
    for (const SumoPhase& phase : signal.phases) {
        end_s += phase.duration_s;
        const std::int64_t end = to_ticks(end_s, step_s);
        const Light light = light_of(phase.state[static_cast<std::size_t>(link)]);
        if (end == begin) continue;
        if (!stages.empty() && stages.back().light == light) {
            stages.back().ticks += end - begin;
        } else {
            stages.push_back({end - begin, light});
        }
        begin = end;
    }
    std::int64_t offset = offset_ticks(signal, step_s);
    // If the first and the last stage have the same light, the first stage is merged into the last stage. The programme
    // then begins with the second stage.
    if (stages.size() > 1 && stages.front().light == stages.back().light) {
        offset += stages.front().ticks;
        stages.back().ticks += stages.front().ticks;
        stages.erase(stages.begin());
    }
    const std::int64_t cycle = begin;
    return {std::move(stages), (offset % cycle + cycle) % cycle - cycle, true};
}

// Makes the plan of a signal that reacts to traffic. `links`: the link of each group.
SignalPlan controlled_plan(const SumoSignal& signal, std::vector<int> groups, const std::vector<int>& links,
                           std::vector<GroupProgramme> programmes, double step_s) {
    const SumoController& from = *signal.controller;
    SignalPlan plan;
    plan.controller = &find_signal_controller(from.settings.controller);
    plan.groups = std::move(groups);
    plan.settings = from.settings;
    plan.values.assign(plan.controller->parameters.size(), 0.0);
    plan.step_s = step_s;
    plan.phases = make_phase_plan(from.settings, {}, step_s);
    if (plan.controller->runs_rings) plan.phases.rings = make_ring_plan(from.settings, {}, step_s);
    for (std::size_t k = 0; k < from.states.size(); ++k) {
        for (std::size_t group = 0; group < links.size(); ++group) {
            const char letter = from.states[k][static_cast<std::size_t>(links[group])];
            const std::uint64_t bit = std::uint64_t{1} << group;
            if (sumo_is_green(letter)) plan.phases.phases[k].green_groups |= bit;
            if (letter == 'G' && plan.controller->runs_rings) plan.phases.rings.phases[k].protected_groups |= bit;
        }
    }
    if (plan.controller->runs_rings) {
        RingPlan& rings = plan.phases.rings;
        rings.cycle_start_tick = to_ticks(from.cycle_start_s, step_s);
        plan.programmes = make_ring_programmes(plan.phases, static_cast<int>(links.size()));
    } else {
        plan.programmes = std::move(programmes);
    }
    plan.nominal_cycle_ticks = to_ticks(plan.controller->nominal_cycle(from.settings, 0).cycle_s, step_s);
    plan.lane_detectors = from.detectors;
    return plan;
}

}  // namespace

SignalPlans make_sumo_signals(const SumoNetwork& network, double step_s) {
    struct Parts {
        std::vector<int> groups;
        std::vector<int> links;
        std::vector<GroupProgramme> programmes;
    };
    std::map<int, Parts> by_signal;
    for (std::size_t group = 0; group < network.lights.size(); ++group) {
        const SumoLight& light = network.lights[group];
        auto& [groups, links, programmes] = by_signal[light.signal];
        groups.push_back(static_cast<int>(group));
        links.push_back(light.link);
        if (light.signal < 0) {
            programmes.emplace_back(std::vector<Stage>{{to_ticks(3600.0, step_s), Light::green}}, 0, true);
        } else {
            programmes.push_back(
                programme_of(network.net.signals[static_cast<std::size_t>(light.signal)], light.link, step_s));
        }
    }
    SignalPlans plans;
    for (auto& [number, parts] : by_signal) {
        const SumoSignal* const signal = number < 0 ? nullptr : &network.net.signals[static_cast<std::size_t>(number)];
        if (signal == nullptr || signal->controller == nullptr) {
            plans.add(fixed_time_plan(std::move(parts.groups), std::move(parts.programmes)));
        } else {
            plans.add(
                controlled_plan(*signal, std::move(parts.groups), parts.links, std::move(parts.programmes), step_s));
        }
    }
    return plans;
}

std::vector<PhasePriority> make_sumo_phase_priorities(const SumoNetwork& network, double step_s) {
    std::vector<PhasePriority> priorities;
    for (const SumoPhasePriority& changing : network.phase_priorities) {
        const SumoSignal& signal = network.net.signals[static_cast<std::size_t>(changing.signal)];
        if (signal.controller != nullptr) continue;
        std::vector<PriorityStage> stages;
        double end_s = 0.0;
        std::int64_t begin = 0;
        for (std::size_t k = 0; k < signal.phases.size(); ++k) {
            end_s += signal.phases[k].duration_s;
            const std::int64_t end = to_ticks(end_s, step_s);
            if (end == begin) continue;
            if (!stages.empty() && stages.back().priority == changing.by_phase[k]) {
                stages.back().ticks += end - begin;
            } else {
                stages.push_back({end - begin, changing.by_phase[k]});
            }
            begin = end;
        }
        priorities.emplace_back(changing.first, changing.second, std::move(stages), offset_ticks(signal, step_s));
    }
    return priorities;
}

std::vector<PriorityByPhase> make_sumo_priorities_by_phase(const SumoNetwork& network) {
    std::map<int, int> plan_of;  // [index in SumoNet::signals] index in the result of make_sumo_signals()
    for (const SumoLight& light : network.lights) plan_of[light.signal] = 0;
    int plans = 0;
    for (auto& [signal, plan] : plan_of) plan = plans++;
    std::vector<PriorityByPhase> priorities;
    for (const SumoPhasePriority& changing : network.phase_priorities) {
        const SumoSignal& signal = network.net.signals[static_cast<std::size_t>(changing.signal)];
        if (signal.controller == nullptr) continue;
        PriorityByPhase by_phase{plan_of.at(changing.signal), changing.first, changing.second, {}};
        for (const int phase : signal.controller->sumo_phases)
            by_phase.by_phase.emplace_back(changing.by_phase[static_cast<std::size_t>(phase)]);
        priorities.push_back(std::move(by_phase));
    }
    return priorities;
}

}  // namespace stopline
