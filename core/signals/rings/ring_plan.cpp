#include "signals/rings/ring_plan.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "signals/signal_phases.h"

namespace stopline {

namespace {

std::size_t index_of(int number) { return static_cast<std::size_t>(number); }

std::size_t ring_of(const PhaseSettings& phase) { return phase.ring == 2 ? 1 : 0; }

// Returns the number of the side of each phase, counted in the order of the file.
std::vector<int> sides_of(const std::vector<PhaseSettings>& phases) {
    std::map<int, int> side_of_barrier;
    std::vector<int> sides;
    for (const PhaseSettings& phase : phases) {
        sides.push_back(
            side_of_barrier.try_emplace(phase.barrier, static_cast<int>(side_of_barrier.size())).first->second);
    }
    return sides;
}

// Sets ring, side, order and pairs.
RingPlan ring_structure(const std::vector<PhaseSettings>& phases) {
    RingPlan plan;
    const std::vector<int> sides = sides_of(phases);
    const int count = sides.empty() ? 0 : *std::max_element(sides.begin(), sides.end()) + 1;
    for (auto& order : plan.order) order.resize(index_of(count));
    for (std::size_t k = 0; k < phases.size(); ++k) {
        RingPhase phase;
        phase.ring = ring_of(phases[k]);
        phase.side = sides[k];
        std::vector<int>& order = plan.order[phase.ring][index_of(phase.side)];
        phase.place = static_cast<int>(order.size());
        order.push_back(static_cast<int>(k));
        plan.phases.push_back(phase);
    }
    for (int side = 0; side < count; ++side) {
        std::vector<int> first{-1};
        std::vector<int> second{-1};
        first.insert(first.end(), plan.order[0][index_of(side)].begin(), plan.order[0][index_of(side)].end());
        second.insert(second.end(), plan.order[1][index_of(side)].begin(), plan.order[1][index_of(side)].end());
        for (const int a : first) {
            for (const int b : second) {
                if (a >= 0 || b >= 0) plan.pairs.push_back({{a, b}});
            }
        }
    }
    return plan;
}

// Sets the points of all phases in the background cycle.
void set_points(const std::vector<PhaseSettings>& phases, double step_s, RingPlan& plan) {
    const auto clearance = [&](int k) {
        return to_ticks(phases[index_of(k)].yellow_s, step_s) + to_ticks(phases[index_of(k)].all_red_s, step_s);
    };
    std::int64_t side_start = 0;
    for (int side = 0; side < plan.sides(); ++side) {
        std::int64_t side_end = side_start;
        std::int64_t longest_clearance = 0;
        for (const auto& order : plan.order) {
            std::int64_t start = side_start;
            for (const int k : order[index_of(side)]) {
                RingPhase& phase = plan.phases[index_of(k)];
                phase.start_point = start;
                phase.force_off = start + to_ticks(phases[index_of(k)].green_s, step_s);
                start = phase.force_off + clearance(k);
                longest_clearance = std::max(longest_clearance, clearance(k));
            }
            side_end = std::max(side_end, start);
        }
        // Any phase of the side can be the last one before the barrier.
        for (const auto& order : plan.order) {
            for (const int k : order[index_of(side)]) {
                std::int64_t& force_off = plan.phases[index_of(k)].force_off;
                force_off = std::min(force_off, side_end - longest_clearance);
            }
        }
        side_start = side_end;
    }
}

// The times of a phase in a cycle in which each phase has its green time, in ticks from the start of the cycle.
struct ScheduledPhase {
    int phase;
    int next;
    std::int64_t start;
    std::int64_t green_end;
    std::int64_t yellow_end;
    std::int64_t end;  // of the time until the next phase of the ring
};

std::vector<ScheduledPhase> schedule_of(const PhasePlan& plan, std::size_t ring, std::int64_t& cycle_ticks) {
    const RingPlan& rings = plan.rings;
    const auto ticks_of = [&](const std::vector<int>& order) {
        std::int64_t sum = 0;
        for (const int k : order) sum += plan.phases[index_of(k)].ticks();
        return sum;
    };
    std::vector<ScheduledPhase> schedule;
    std::int64_t start = 0;
    for (int side = 0; side < rings.sides(); ++side) {
        const auto& order = rings.order[ring][index_of(side)];
        const std::int64_t side_end =
            start + std::max(ticks_of(rings.order[0][index_of(side)]), ticks_of(rings.order[1][index_of(side)]));
        for (const int k : order) {
            const SignalPhase& phase = plan.phases[index_of(k)];
            const std::int64_t end = k == order.back() ? side_end : start + phase.ticks();
            const std::int64_t green_end = end - phase.yellow_ticks - phase.all_red_ticks;
            schedule.push_back({k, -1, start, green_end, green_end + phase.yellow_ticks, end});
            start = end;
        }
        start = side_end;
    }
    cycle_ticks = start;
    for (std::size_t k = 0; k < schedule.size(); ++k) {
        const ScheduledPhase& next = schedule[(k + 1) % schedule.size()];
        if (next.start == schedule[k].end % cycle_ticks) schedule[k].next = next.phase;
    }
    return schedule;
}

Light scheduled_light(const PhasePlan& plan, const std::vector<ScheduledPhase>& schedule, int group,
                      std::int64_t tick) {
    for (const ScheduledPhase& one : schedule) {
        if (tick < one.start || tick >= one.end || !plan.phases[index_of(one.phase)].has_green(group)) continue;
        const bool goes_on = one.next >= 0 && plan.phases[index_of(one.next)].has_green(group);
        if (tick < one.green_end || goes_on) return Light::green;
        return tick < one.yellow_end ? Light::yellow : Light::red;
    }
    return Light::red;
}

}  // namespace

int RingPlan::pair(const RingPair& wanted) const {
    const auto found = std::find(pairs.begin(), pairs.end(), wanted);
    return found == pairs.end() ? -1 : static_cast<int>(found - pairs.begin());
}

RingPlan make_ring_plan(const SignalSettings& settings, std::span<const std::string> movements, double step_s) {
    RingPlan plan = ring_structure(settings.phases);
    for (std::size_t k = 0; k < settings.phases.size(); ++k) {
        const PhaseSettings& phase = settings.phases[k];
        plan.phases[k].has_dual_entry = phase.dual_entry == "on";
        plan.phases[k].is_coordinated = phase.is_coordinated();
        if (phase.is_coordinated()) plan.coordinated[plan.phases[k].ring] = static_cast<int>(k);
        for (std::size_t group = 0; group < movements.size(); ++group) {
            if (has_protected_green(phase, movements[group]))
                plan.phases[k].protected_groups |= std::uint64_t{1} << group;
        }
    }
    set_points(settings.phases, step_s, plan);
    plan.cycle_ticks = to_ticks(settings.cycle_s, step_s);
    plan.cycle_start_tick = to_ticks(settings.first_green_s, step_s);
    return plan;
}

std::vector<PhaseSettings> ring_pair_phases(const SignalSettings& settings) {
    std::vector<PhaseSettings> phases;
    for (const RingPair& pair : ring_structure(settings.phases).pairs) {
        PhaseSettings both;
        for (const int k : pair.phase) {
            if (k < 0) continue;
            const PhaseSettings& one = settings.phases[index_of(k)];
            if (both.protected_movements.empty() && both.permissive_movements.empty()) both = one;
            for (const std::string& name : one.protected_movements) {
                std::erase(both.permissive_movements, name);
                if (!has_protected_green(both, name)) both.protected_movements.push_back(name);
            }
            for (const std::string& name : one.permissive_movements) {
                if (!has_green(both, name)) both.permissive_movements.push_back(name);
            }
        }
        phases.push_back(std::move(both));
    }
    return phases;
}

std::string pair_text(const RingPair& pair) {
    if (pair.phase[0] < 0) return fmt::format("phase {}", pair.phase[1] + 1);
    if (pair.phase[1] < 0) return fmt::format("phase {}", pair.phase[0] + 1);
    return fmt::format("phases {} and {}", pair.phase[0] + 1, pair.phase[1] + 1);
}

std::vector<GroupProgramme> make_ring_programmes(const PhasePlan& plan, int groups) {
    std::int64_t cycle_ticks = 0;
    std::array<std::vector<ScheduledPhase>, kRings> schedules;
    for (std::size_t ring = 0; ring < kRings; ++ring) schedules[ring] = schedule_of(plan, ring, cycle_ticks);
    std::vector<GroupProgramme> programmes;
    for (int group = 0; group < groups; ++group) {
        std::vector<Stage> stages;
        for (std::int64_t tick = 0; tick < cycle_ticks; ++tick) {
            const Light first = scheduled_light(plan, schedules[0], group, tick);
            const Light second = scheduled_light(plan, schedules[1], group, tick);
            const bool is_green = first == Light::green || second == Light::green;
            const bool is_yellow = first == Light::yellow || second == Light::yellow;
            const Light light = is_green ? Light::green : is_yellow ? Light::yellow : Light::red;
            if (stages.empty() || stages.back().light != light) stages.push_back({0, light});
            ++stages.back().ticks;
        }
        programmes.emplace_back(std::move(stages), plan.rings.cycle_start_tick, true);
    }
    return programmes;
}

double ring_cycle_s(const SignalSettings& settings) {
    const RingPlan plan = ring_structure(settings.phases);
    double cycle_s = 0.0;
    for (int side = 0; side < plan.sides(); ++side) {
        double longest_s = 0.0;
        for (const auto& order : plan.order) {
            double ring_s = 0.0;
            for (const int k : order[index_of(side)]) ring_s += settings.phases[index_of(k)].total_s();
            longest_s = std::max(longest_s, ring_s);
        }
        cycle_s += longest_s;
    }
    return cycle_s;
}

}  // namespace stopline
