#include "experiment/run_metrics.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "experiment/csv.h"
#include "experiment/single_light.h"
#include "sim/model.h"

namespace stopline {

namespace {

// A whole number of steps of about kSampleInterval_s.
double sample_interval_s(const Scenario& scenario) {
    const std::int64_t ticks = std::max<std::int64_t>(1, to_ticks(kSampleInterval_s, scenario.step_s));
    return static_cast<double>(ticks) * scenario.step_s;
}

// The queue at a single light: what summary.csv of stopline-run holds too.
std::vector<RunMetric> approach_metrics(const Scenario& scenario, std::size_t population, const RunResult& run,
                                        double interval_s) {
    const PopulationSummary summary = summary_of(scenario, population, run, run.trajectory, interval_s);
    std::vector<RunMetric> metrics;
    for (std::size_t k = 0; k < summary.passed.size(); ++k) {
        metrics.push_back(count_metric(fmt::format("passed_{}", k + 1), "veh", summary.passed[k]));
    }
    metrics.push_back(number_metric("emptied", "s", summary.emptied_s, 6));
    metrics.push_back(count_metric("settled", "veh", summary.settled.vehicles));
    metrics.push_back(number_metric("settled_headway", "s", summary.settled.headway_s, 6));
    metrics.push_back(number_metric("settled_net_gap", "m", summary.settled.net_gap_m, 6));
    return metrics;
}

void add_common_metrics(const RunResult& run, std::vector<RunMetric>& metrics) {
    metrics.push_back(count_metric("vehicles_entered", "", run.vehicles_entered));
    metrics.push_back(count_metric("vehicles_left", "", run.vehicles_left));
    metrics.push_back(count_metric("overlaps", "", run.violations.overlaps));
    metrics.push_back(count_metric("red_entries", "", run.violations.red_entries));
    metrics.push_back(count_metric("forced_red_entries", "", run.violations.forced_red_entries));
    metrics.push_back(count_metric("lost_vehicles", "", run.violations.lost_vehicles));
    metrics.push_back(count_metric("updates", "", run.updates));
    metrics.push_back({"state_hash", "", fmt::format("{:016x}", run.state_hash)});
}

}  // namespace

RunMetric number_metric(std::string name, std::string unit, double value, int decimals) {
    return {std::move(name), std::move(unit), fixed(value, decimals)};
}

RunMetric count_metric(std::string name, std::string unit, std::int64_t value) {
    return {std::move(name), std::move(unit), fmt::format("{}", value)};
}

std::vector<RunMetric> run_metrics(const Scenario& scenario, std::size_t population,
                                   const std::function<bool()>& keep_going) {
    RunOptions options;
    options.trajectory_interval_s = sample_interval_s(scenario);
    options.trajectory_from_s = scenario.signal.first_green_s - kLeadIn_s;
    options.trajectory_until_s = scenario.signal.first_green_s + scenario.signal.green_s + kLeadOut_s;
    options.on_progress = [&](double) { return !keep_going || keep_going(); };
    const RunResult run = run_population(scenario, population, options);
    if (!run.complete) return {};
    std::vector<RunMetric> metrics = approach_metrics(scenario, population, run, options.trajectory_interval_s);
    add_common_metrics(run, metrics);
    return metrics;
}

}  // namespace stopline
