#include "sumo_import/sumo_signals.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

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

}  // namespace

SignalPlans make_sumo_signals(const SumoNetwork& network, double step_s) {
    std::map<int, std::pair<std::vector<int>, std::vector<GroupProgramme>>> by_signal;
    for (std::size_t group = 0; group < network.lights.size(); ++group) {
        const SumoLight& light = network.lights[group];
        auto& [groups, programmes] = by_signal[light.signal];
        groups.push_back(static_cast<int>(group));
        if (light.signal < 0) {
            programmes.emplace_back(std::vector<Stage>{{to_ticks(3600.0, step_s), Light::green}}, 0, true);
        } else {
            programmes.push_back(
                programme_of(network.net.signals[static_cast<std::size_t>(light.signal)], light.link, step_s));
        }
    }
    SignalPlans plans;
    for (auto& [signal, groups] : by_signal) {
        plans.add(fixed_time_plan(std::move(groups.first), std::move(groups.second)));
    }
    return plans;
}

std::vector<PhasePriority> make_sumo_phase_priorities(const SumoNetwork& network, double step_s) {
    std::vector<PhasePriority> priorities;
    for (const SumoPhasePriority& changing : network.phase_priorities) {
        const SumoSignal& signal = network.net.signals[static_cast<std::size_t>(changing.signal)];
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

}  // namespace stopline
