// Section III of the paper: inputs (rows P01 to P06 of data/paper/targets.csv) and the single traffic light (L01 to
// L15).
//
// A count is the number of vehicles whose front has passed the stop line since the start of green. In a row with the
// condition green=T, the improvement compares the counts of two populations at time T. The condition green>=T stands
// for the flat part of the curve in Fig. 6. In a row with this condition, the improvement is the mean of our curve from
// time T on, so that a single vehicle has little influence. The mean ends at the end of green, or earlier when all 60
// vehicles of one of the two queues have passed.
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "base/io/csv.h"
#include "paper/sections/scorecard_sections.h"
#include "runs/single_light/single_light.h"

namespace stopline {

namespace {

constexpr const char* kInputs = "single_light_inputs";
constexpr const char* kRuns = "single_light";
constexpr double kGapLimit_kmh = 50.0;

std::string timed(const char* quantity, const std::string& population, double time_s) {
    return fmt::format("{} {} {:.6g}", quantity, population, time_s);
}

Measurements inputs_of(const Scenario& scenario, const ScorecardOptions& /*options*/) {
    Measurements inputs;
    for (const GapPolicySettings& policy : scenario.policies) {
        if (find_gap_law(policy.law).is_human) continue;  // not a policy of the paper
        inputs.set("time_gap " + policy.name, law_parameter(policy, "time_gap"));
        inputs.set("standstill_gap " + policy.name, policy.standstill_gap_m);
    }
    inputs.set("vehicle_length", scenario.vehicle.length_m);
    inputs.set("sensor_delay", scenario.driver.cacc.radar_delay_s);
    return inputs;
}

Measurements measure_single_light(const Scenario& scenario, const ScorecardOptions& options) {
    SingleLightOptions run_options;
    run_options.threads = options.threads;
    run_options.on_progress = options.on_progress;
    const SingleLightReport result = run_single_light(scenario, run_options);
    Measurements measured;
    double violations = 0.0;
    for (std::size_t k = 0; k < result.populations.size(); ++k) {
        const PopulationSummary& summary = result.populations[k];
        for (std::size_t i = 0; i < scenario.measure.green_s.size(); ++i) {
            const double green_s = scenario.measure.green_s[i];
            measured.set(timed("passed", summary.name, green_s), summary.passed[i]);
            measured.set(timed("counter", summary.name, green_s), summary.counter.interpolated(green_s));
            measured.set(timed("improvement", summary.name, green_s), summary.improvement_percent[i]);
            measured.set(timed("improvement_from", summary.name, green_s),
                         result.mean_improvement_percent(summary, green_s));
        }
        measured.set("leader_to_limit " + summary.name, summary.leader.duration_s());
        measured.set("steady_gap " + summary.name, summary.steady.net_gap_m);
        measured.set("steady_headway " + summary.name, summary.steady.headway_s);
        measured.set("policy_headway " + summary.name, summary.steady.policy_headway_s);
        const Violations& found = result.runs[k].violations;
        violations += static_cast<double>(found.overlaps + found.red_entries + std::abs(found.lost_vehicles));
    }
    measured.set("speed_limit_kmh", 3.6 * scenario.network.approach.speed_limit_mps);
    measured.set("violations", violations);
    return measured;
}

std::optional<Answer> number_named(const Measurements& measured, const std::string& name) {
    const std::optional<double> value = measured.find(name);
    if (!value) return std::nullopt;
    return number_answer(*value);
}

// Returns the measured value that is farthest from the value of the paper, among all measurements whose name starts
// with `prefix`. NaN counts as farthest. The measurement named `excluded` is ignored.
std::optional<Answer> farthest(const Target& target, const Measurements& measured, const std::string& prefix,
                               const std::string& excluded = "") {
    const double paper = parse_number(target.value).value_or(0.0);
    std::optional<double> worst;
    for (const auto& [name, value] : measured.values()) {
        if (!name.starts_with(prefix) || name == excluded) continue;
        const bool farther = !worst || std::isnan(value) || std::abs(value - paper) > std::abs(*worst - paper);
        if (farther && !(worst && std::isnan(*worst))) worst = value;
    }
    if (!worst) return std::nullopt;
    return number_answer(*worst);
}

std::optional<Answer> time_gap(const Target& target, const Measurements& inputs) {
    return number_named(inputs, "time_gap " + target.condition);
}

// Ignores CDG-6m, because this policy has a larger standstill gap on purpose.
std::optional<Answer> standstill_gap(const Target& target, const Measurements& inputs) {
    return farthest(target, inputs, "standstill_gap ", "standstill_gap CDG-6m");
}

std::optional<Answer> vehicle_length(const Target& /*target*/, const Measurements& inputs) {
    return number_named(inputs, "vehicle_length");
}

std::optional<Answer> sensor_delay(const Target& /*target*/, const Measurements& inputs) {
    return number_named(inputs, "sensor_delay");
}

std::optional<Answer> vehicles_passed(const Target& target, const Measurements& measured) {
    const std::optional<GreenCondition> condition = parse_green_condition(target.condition);
    if (!condition) return std::nullopt;
    return number_named(measured, timed("passed", condition->population, condition->green_s));
}

std::optional<Answer> improvement(const Target& target, const Measurements& measured) {
    const std::optional<GreenCondition> condition = parse_green_condition(target.condition);
    if (!condition) return std::nullopt;
    const char* const quantity = condition->and_above ? "improvement_from" : "improvement";
    return number_named(measured, timed(quantity, condition->population, condition->green_s));
}

std::optional<Answer> leader_time(const Target& target, const Measurements& measured) {
    return farthest(target, measured, "leader_to_limit ");
}

std::optional<Answer> gap_at_limit(const Target& target, const Measurements& measured) {
    const double limit_kmh = measured.find("speed_limit_kmh").value_or(0.0);
    if (std::abs(limit_kmh - kGapLimit_kmh) > 1e-6) return std::nullopt;
    return number_named(measured, "steady_gap " + target.condition);
}

// Checks an order of throughputs such as "A > B = C". 'A > B' holds if the count of A, interpolated between passages,
// is larger than that of B. 'B = C' holds if the whole counts of B and C differ by at most one vehicle, the resolution
// of the experiment.
std::optional<Answer> order_of_throughput(const Target& target, const Measurements& measured) {
    const std::optional<double> green_s =
        parse_number(target.condition.starts_with("green=") ? target.condition.substr(6) : "");
    if (!green_s) return std::nullopt;
    bool holds = true;
    std::string text;
    std::string relation;
    double last_passed = 0.0;
    double last_counter = 0.0;
    for (std::size_t begin = 0; begin < target.value.size();) {
        const std::size_t end = std::min(target.value.find(' ', begin), target.value.size());
        const std::string word = target.value.substr(begin, end - begin);
        begin = end + 1;
        if (word == ">" || word == "=") {
            relation = word;
            continue;
        }
        const std::optional<double> passed = measured.find(timed("passed", word, *green_s));
        const std::optional<double> counter = measured.find(timed("counter", word, *green_s));
        if (!passed || !counter) return std::nullopt;
        if (relation == ">") holds = holds && last_counter > *counter;
        if (relation == "=") holds = holds && std::abs(last_passed - *passed) <= 1.0;
        text += fmt::format("{}{} {:.0f}", text.empty() ? "" : ", ", word, *passed);
        last_passed = *passed;
        last_counter = *counter;
    }
    return claim_answer(holds, text);
}

}  // namespace

std::span<const Experiment> section3_experiments() {
    static const std::array kExperiments{Experiment{kInputs, "single_light", false, inputs_of},
                                         Experiment{kRuns, "single_light", true, measure_single_light}};
    return kExperiments;
}

std::span<const RowJudge> section3_rows() {
    static const std::array kRows{RowJudge{"P01", kInputs, time_gap},         RowJudge{"P02", kInputs, standstill_gap},
                                  RowJudge{"P03", kInputs, vehicle_length},   RowJudge{"P04", kInputs, time_gap},
                                  RowJudge{"P05", kInputs, time_gap},         RowJudge{"P06", kInputs, sensor_delay},
                                  RowJudge{"L01", kRuns, vehicles_passed},    RowJudge{"L02", kRuns, vehicles_passed},
                                  RowJudge{"L03", kRuns, vehicles_passed},    RowJudge{"L04", kRuns, vehicles_passed},
                                  RowJudge{"L05", kRuns, vehicles_passed},    RowJudge{"L06", kRuns, vehicles_passed},
                                  RowJudge{"L07", kRuns, vehicles_passed},    RowJudge{"L08", kRuns, improvement},
                                  RowJudge{"L09", kRuns, improvement},        RowJudge{"L10", kRuns, improvement},
                                  RowJudge{"L11", kRuns, improvement},        RowJudge{"L12", kRuns, improvement},
                                  RowJudge{"L13", kRuns, leader_time},        RowJudge{"L14", kRuns, gap_at_limit},
                                  RowJudge{"L15", kRuns, order_of_throughput}};
    return kRows;
}

}  // namespace stopline
