#include "runs/run_metrics.h"

#include <algorithm>
#include <cstdint>

#include "runs/intersection/intersection_metrics.h"
#include "runs/metrics/metric_groups.h"
#include "runs/metrics/metric_tables.h"
#include "runs/network/network_metrics.h"
#include "runs/run_kind.h"
#include "runs/single_light/single_light_metrics.h"
#include "scenario/kinds/network_kind.h"
#include "sim/state/model.h"

namespace stopline {

namespace {

// Returns the whole number of steps that is closest to kSampleInterval_s, as a time in s. It is at least one step.
double sample_interval_s(const Scenario& scenario) {
    const std::int64_t ticks = std::max<std::int64_t>(1, to_ticks(kSampleInterval_s, scenario.tick_s()));
    return static_cast<double>(ticks) * scenario.tick_s();
}

std::vector<RunMetric> run_light(const Scenario& scenario, std::size_t population,
                                 const std::function<bool()>& keep_going) {
    RunOptions options;
    options.trajectory_interval_s = sample_interval_s(scenario);
    options.trajectory_from_s = scenario.signal.first_green_s - kTrajectoryBefore_s;
    options.trajectory_until_s = scenario.signal.first_green_s + scenario.signal.green_s + kTrajectoryAfter_s;
    options.on_progress = [&](double) { return !keep_going || keep_going(); };
    const RunResult run = run_population(scenario, population, options);
    if (!run.complete) return {};
    const PopulationSummary summary =
        summary_of(scenario, population, run, run.trajectory, options.trajectory_interval_s);
    return sweep_metrics(single_light_metrics(), MeasuredLight{scenario, summary, run});
}

std::vector<RunMetric> run_junction(const Scenario& scenario, std::size_t population,
                                    const std::function<bool()>& keep_going) {
    constexpr std::int64_t kProgressSteps = 1000;
    const IntersectionResult result = run_intersection(scenario, population, [&](const Simulation& simulation) {
        return !keep_going || simulation.state().tick % kProgressSteps != 0 || keep_going();
    });
    if (!result.complete) return {};
    return sweep_metrics(intersection_metrics(), MeasuredIntersection{scenario, result});
}

std::vector<RunMetric> run_whole_network(const Scenario& scenario, std::size_t population,
                                         const std::function<bool()>& keep_going) {
    constexpr std::int64_t kProgressSteps = 200;
    const NetworkResult result = run_network(scenario, population, [&](const Simulation& simulation) {
        return !keep_going || simulation.state().tick % kProgressSteps != 0 || keep_going();
    });
    if (!result.complete) return {};
    return sweep_metrics(network_metrics(), MeasuredNetwork{scenario, result});
}

TimeWindow whole_run(const Scenario& scenario) { return {0.0, scenario.duration_s}; }

TimeWindow end_of_run(const Scenario& scenario) {
    return {std::max(0.0, scenario.duration_s - scenario.measure.window_s), scenario.duration_s};
}

}  // namespace

extern const RunKind kSingleLightRun{kRunAsSingleLight, run_light, whole_run};
extern const RunKind kIntersectionRun{kRunAsIntersection, run_junction, measured_window};
extern const RunKind kNetworkRun{kRunAsNetwork, run_whole_network, end_of_run};

std::vector<RunMetric> run_metrics(const Scenario& scenario, std::size_t population,
                                   const std::function<bool()>& keep_going) {
    return run_kind(scenario).metrics(scenario, population, keep_going);
}

std::vector<std::string> result_columns(const Scenario& scenario) {
    return metric_group_of(scenario.network).sweep_columns(scenario);
}

}  // namespace stopline
