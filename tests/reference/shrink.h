// Shrinks a plan in which core/sim and the reference engine differ.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "reference/comparison.h"

namespace stopline::reference_engine {

// A plan in which the engines differ.
struct Failure {
    Plan plan;
    Difference difference;

    std::string text() const {
        const std::string routes =
            plan.roads == Plan::Roads::imported ? "\nThe file plan.rou.xml:\n" + routes_of(plan) : "";
        return difference.text() + routes + "\nThe smallest scenario found:\n" + yaml_of(plan);
    }
};

using Change = std::function<void(Plan&)>;

// Returns a change that gives a field its default.
template <class Field>
Change reset(Field Plan::*field) {
    return [field](Plan& p) { p.*field = Plan().*field; };
}

// Returns changes that simplify a plan: fewer vehicles, fewer policies and lanes, a shorter duration, defaults.
inline std::vector<Change> simplifications(const Failure& failure) {
    std::vector<Change> changes{
        [](Plan& p) { p.trips.resize(p.trips.size() / 2); },
        [](Plan& p) {
            p.trips.erase(p.trips.begin(), p.trips.begin() + static_cast<std::ptrdiff_t>(p.trips.size() / 2));
        },
        [](Plan& p) { p.vehicles /= 2; },
        [](Plan& p) { --p.vehicles; },
        [](Plan& p) { p.components = {p.components.front()}; },
        [](Plan& p) { p.components = {p.components.back()}; },
        [](Plan& p) { p.components.pop_back(); },
        [](Plan& p) {
            for (Plan::Component& component : p.components) component.vehicle = component.driver = "";
        },
        [](Plan& p) { p.roads = p.roads == Plan::Roads::grid ? Plan::Roads::intersection : p.roads; },
        [](Plan& p) {
            if (p.movements.size() > 1) p.movements = {"straight+left+right"};
        },
        [](Plan& p) { p.lanes = 1; },
        [](Plan& p) { p.demand = "queue"; },
        [](Plan& p) { p.dawdling = p.meso.empty() ? p.dawdling : 0.0; },
        [](Plan& p) { p.limit_kmh = 50.0; },
        [](Plan& p) { p.cycle_s = 0.0; },
        [](Plan& p) { p.first_green_s = 0.0; },
        [&failure](Plan& p) { p.duration_s = std::ceil(std::max(failure.difference.time_s, p.first_green_s + 1.0)); }};
    for (std::size_t k = 0; k < failure.plan.trips.size(); ++k) {
        changes.emplace_back([k](Plan& p) {
            if (k < p.trips.size()) p.trips.erase(p.trips.begin() + static_cast<std::ptrdiff_t>(k));
        });
    }
    for (double Plan::*const field :
         {&Plan::gradient_percent, &Plan::exit_limit_kmh, &Plan::left_percent, &Plan::right_percent,
          &Plan::hesitation_s, &Plan::stop_margin_m, &Plan::stop_mps2, &Plan::decision_mps2, &Plan::critical_gap_s,
          &Plan::critical_lag_s, &Plan::radar_delay_ms, &Plan::v2v_delay_ms, &Plan::gap_share_percent,
          &Plan::politeness, &Plan::keep_right_mps2, &Plan::reaction_s, &Plan::gap_error}) {
        changes.push_back(reset(field));
    }
    changes.push_back(reset(&Plan::max_platoon));
    changes.push_back(reset(&Plan::starts_queued));
    changes.push_back(reset(&Plan::keeps_clear));
    changes.push_back(reset(&Plan::vehicle));
    changes.push_back(reset(&Plan::gap_opening));
    changes.push_back(reset(&Plan::pattern));
    return changes;
}

// Simplifies a plan as long as the engines still differ.
inline Failure shrunk(Failure failure, const Tolerance& tolerance, const UndocumentedRules& rules = {}) {
    for (bool has_changed = true; has_changed;) {
        has_changed = false;
        for (const Change& change : simplifications(failure)) {
            Plan smaller = failure.plan;
            change(smaller);
            if (smaller.components.empty()) continue;
            double share_percent = 100.0;
            for (const Plan::Component& component : smaller.components) share_percent -= component.share_percent;
            smaller.components.back().share_percent += share_percent;
            if (yaml_of(smaller) + routes_of(smaller) == yaml_of(failure.plan) + routes_of(failure.plan)) continue;
            try {
                const Comparison comparison = compare_engines(smaller, tolerance, rules);
                if (!comparison.difference) continue;
                failure = {smaller, *comparison.difference};
                has_changed = true;
            } catch (const InputError&) {
                continue;  // the smaller plan is no valid scenario
            }
        }
    }
    return failure;
}

}  // namespace stopline::reference_engine
