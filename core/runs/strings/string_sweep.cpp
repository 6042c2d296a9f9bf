#include "runs/strings/string_sweep.h"

#include <algorithm>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/nan.h"
#include "spacing_laws/gap_policy.h"

namespace stopline {

namespace {

// Returns the scenario with its first population only, and a reference to the policy of this population in `policy`.
Scenario first_population_of(const Scenario& scenario, std::size_t& policy) {
    Scenario one = scenario;
    one.populations.resize(1);
    const PopulationSettings& population = one.populations[0];
    if (population.components.size() != 1) {
        throw InputError(
            fmt::format("--sweep: population '{}' has several policies; give one policy, such as "
                        "--population CTG-Ref",
                        population.name));
    }
    const auto known = std::find_if(one.policies.begin(), one.policies.end(), [&](const GapPolicySettings& settings) {
        return settings.name == population.components[0].policy;
    });
    if (known == one.policies.end()) throw InputError("--sweep: unknown policy " + population.components[0].policy);
    const GapLaw& law = find_gap_law(known->law);
    const bool has_time_gap = std::any_of(
        law.parameters.begin(), law.parameters.end(),
        [](const LawParameter& parameter) { return std::string_view(parameter.name) == kTimeGapParameter.name; });
    if (!has_time_gap || law.is_human) {
        throw InputError(
            fmt::format("--sweep: policy '{}' has the law '{}', which has no time gap for automated "
                        "vehicles; give a policy with a time gap, such as --population CTG-Ref",
                        known->name, known->law));
    }
    policy = static_cast<std::size_t>(known - one.policies.begin());
    return one;
}

void set_v2v_delay(double delay_s, Scenario& scenario) {
    scenario.driver.cacc.v2v_delay_s = delay_s;
    for (PopulationSettings::Component& component : scenario.populations[0].components) {
        if (component.driver) component.driver->cacc.v2v_delay_s = delay_s;
    }
}

}  // namespace

double measured_border_s(const std::vector<StringSweepPoint>& points) {
    constexpr double kLimit = 1.0 + kSwingTolerance;
    double border_s = kNan;
    for (std::size_t k = points.size(); k-- > 0;) {
        const StringSweepPoint& one = points[k];
        if (one.measured_gain <= kLimit) {
            border_s = one.time_gap_s;
            continue;
        }
        if (k + 1 == points.size()) return kNan;
        const StringSweepPoint& stable = points[k + 1];
        const double share = (one.measured_gain - kLimit) / (one.measured_gain - stable.measured_gain);
        return one.time_gap_s + share * (stable.time_gap_s - one.time_gap_s);
    }
    return border_s;
}

StringSweep sweep_strings(const Scenario& scenario, const StringOptions& options, const StringSweepAxes& axes) {
    std::size_t policy = 0;
    Scenario varied = first_population_of(scenario, policy);
    StringSweep sweep;
    sweep.population = varied.populations[0].name;
    StringOptions swings = options;
    swings.brakes = swings.starts = false;
    const auto runs = static_cast<double>(axes.v2v_delays_s.size() * axes.time_gaps_s.size());
    for (const double delay_s : axes.v2v_delays_s) {
        std::vector<StringSweepPoint> points;
        StringResult last;
        for (const double time_gap_s : axes.time_gaps_s) {
            set_v2v_delay(delay_s, varied);
            set_law_parameter(varied.policies[policy], kTimeGapParameter.name, time_gap_s);
            const auto done = static_cast<double>(sweep.points.size() + points.size());
            if (options.on_progress) {
                swings.on_progress = [&, done](double share) { return options.on_progress((done + share) / runs); };
            }
            const StringReport report = run_strings(varied, swings);
            const StringResult& result = last = report.populations[0];
            const SwingResult& worst = *result.worst_swing();
            points.push_back({delay_s, time_gap_s, worst.measured.mean, worst.frequency_radps, result.linear_peak,
                              result.was_settled});
            sweep.violations.add(result.violations);
            sweep.updates += result.updates;
        }
        sweep.border.push_back({delay_s, measured_border_s(points), last.stable_time_gap_s});
        sweep.points.insert(sweep.points.end(), points.begin(), points.end());
    }
    return sweep;
}

}  // namespace stopline
