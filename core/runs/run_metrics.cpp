#include "runs/run_metrics.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/csv.h"
#include "runs/intersection/intersection_run.h"
#include "runs/network/network_run.h"
#include "runs/network/street_results.h"
#include "runs/run_kind.h"
#include "runs/single_light/single_light.h"
#include "scenario/kinds/network_kind.h"
#include "scenario/make_network.h"
#include "sim/state/model.h"

namespace stopline {

namespace {

// Returns the whole number of steps that is closest to kSampleInterval_s, as a time in s. It is at least one step.
double sample_interval_s(const Scenario& scenario) {
    const std::int64_t ticks = std::max<std::int64_t>(1, to_ticks(kSampleInterval_s, scenario.tick_s()));
    return static_cast<double>(ticks) * scenario.tick_s();
}

void add_counts(std::int64_t entered, std::int64_t exited, const Violations& violations, std::int64_t updates,
                std::uint64_t state_hash, std::vector<RunMetric>& metrics) {
    metrics.push_back(count_metric("vehicles_entered", "", entered));
    metrics.push_back(count_metric("vehicles_exited", "", exited));
    metrics.push_back(count_metric("overlaps", "", violations.overlaps + violations.conflicts));
    metrics.push_back(count_metric("red_entries", "", violations.red_entries));
    metrics.push_back(count_metric("forced_red_entries", "", violations.forced_red_entries));
    metrics.push_back(count_metric("lost_vehicles", "", violations.lost_vehicles));
    metrics.push_back(count_metric("deadlocks", "", violations.deadlocks));
    metrics.push_back(count_metric("updates", "", updates));
    metrics.push_back({"state_hash", "", fmt::format("{:016x}", state_hash)});
}

std::vector<RunMetric> metrics_of(const PopulationSummary& summary, const RunResult& run) {
    std::vector<RunMetric> metrics;
    for (std::size_t k = 0; k < summary.passed.size(); ++k) {
        metrics.push_back(count_metric(fmt::format("passed_{}", k + 1), "veh", summary.passed[k]));
    }
    metrics.push_back(number_metric("queue_emptied", "s", summary.emptied_s, 6));
    metrics.push_back(count_metric("steady_vehicles", "", summary.steady.vehicles));
    metrics.push_back(count_metric("not_closed_up_vehicles", "", summary.steady.not_closed_up));
    metrics.push_back(number_metric("steady_headway", "s", summary.steady.headway_s, 6));
    metrics.push_back(number_metric("steady_net_gap", "m", summary.steady.net_gap_m, 6));
    add_counts(run.vehicles_entered, run.vehicles_exited, run.violations, run.updates, run.state_hash, metrics);
    return metrics;
}

std::vector<RunMetric> approach_metrics(const Scenario& scenario, std::size_t population,
                                        const std::function<bool()>& keep_going) {
    RunOptions options;
    options.trajectory_interval_s = sample_interval_s(scenario);
    options.trajectory_from_s = scenario.signal.first_green_s - kTrajectoryBefore_s;
    options.trajectory_until_s = scenario.signal.first_green_s + scenario.signal.green_s + kTrajectoryAfter_s;
    options.on_progress = [&](double) { return !keep_going || keep_going(); };
    const RunResult run = run_population(scenario, population, options);
    if (!run.complete) return {};
    return metrics_of(summary_of(scenario, population, run, run.trajectory, options.trajectory_interval_s), run);
}

std::vector<RunMetric> metrics_of(const Scenario& scenario, const IntersectionResult& f) {
    std::vector<RunMetric> metrics;
    metrics.push_back(number_metric("throughput", "veh_h", f.throughput_veh_h, 6));
    for (std::size_t k = 0; k < f.zones.size(); ++k) {
        const std::string zone = fmt::format("_{:g}m", scenario.measure.zone_radius_m[k]);
        metrics.push_back(number_metric("travel_time" + zone, "s", f.zones[k].travel_time_s, 6));
        metrics.push_back(number_metric("delay" + zone, "s", f.delay_s[k], 6));
        metrics.push_back(number_metric("density" + zone, "percent", 100.0 * f.zones[k].occupied, 6));
    }
    metrics.push_back(number_metric("density_network", "percent", 100.0 * f.occupied, 6));
    metrics.push_back(number_metric("vehicles_present", "", f.vehicles_present, 6));
    metrics.push_back(number_metric("vehicles_per_green", "", f.discharge.vehicles_per_green, 6));
    metrics.push_back(count_metric("saturated_greens", "", f.discharge.saturated_greens));
    metrics.push_back(number_metric("saturation_headway", "s", f.discharge.saturation_headway_s, 6));
    metrics.push_back(number_metric("startup_lost_time", "s", f.discharge.startup_lost_time_s, 6));
    metrics.push_back(number_metric("queue", "veh", f.queue_veh, 6));
    metrics.push_back(number_metric("longest_queue", "m", f.longest_queue_m, 6));
    metrics.push_back(number_metric("turned_right", "percent", 100.0 * f.right_share, 6));
    metrics.push_back(number_metric("turned_left", "percent", 100.0 * f.left_share, 6));
    metrics.push_back(count_metric("gaps_accepted", "", f.gaps_accepted));
    metrics.push_back(count_metric("starvations", "", static_cast<std::int64_t>(f.starvations.size())));
    metrics.push_back(number_metric("longest_in_junction", "s", f.longest_in_junction_s, 2));
    add_counts(f.entered, f.exited, f.violations, f.updates, f.state_hash, metrics);
    return metrics;
}

std::vector<RunMetric> intersection_metrics(const Scenario& scenario, std::size_t population,
                                            const std::function<bool()>& keep_going) {
    constexpr std::int64_t kProgressSteps = 1000;
    const IntersectionResult f = run_intersection(scenario, population, [&](const Simulation& simulation) {
        return !keep_going || simulation.state().tick % kProgressSteps != 0 || keep_going();
    });
    return f.complete ? metrics_of(scenario, f) : std::vector<RunMetric>{};
}

std::vector<RunMetric> metrics_of(const Scenario& scenario, const NetworkResult& f) {
    const DelayLog& delays = f.delays;
    const double none = std::numeric_limits<double>::quiet_NaN();
    std::vector<RunMetric> metrics;
    metrics.push_back(number_metric("throughput", "veh_h", f.measured.throughput_veh_h(), 6));
    metrics.push_back(number_metric("travel_time", "s", f.measured.travel_time_s, 6));
    metrics.push_back(number_metric("density", "percent", 100.0 * f.measured.occupied, 6));
    for (const OriginDestinationResult& pair : f.origin_destination) {
        const bool is_straight_through = std::abs(static_cast<int>(pair.from) - static_cast<int>(pair.to)) == 2;
        if (!is_straight_through) continue;
        const std::string name = fmt::format("{}_{}", kSideNames[static_cast<std::size_t>(pair.from)],
                                             kSideNames[static_cast<std::size_t>(pair.to)]);
        metrics.push_back(
            number_metric("throughput_" + name, "veh_h", pair.exited * 3600.0 / f.measured.window.length_s(), 6));
        metrics.push_back(number_metric("travel_time_" + name, "s", pair.travel_time_s, 6));
    }
    metrics.push_back(number_metric("vehicles_in_area", "", f.measured.vehicles, 6));
    metrics.push_back(number_metric("vehicles_present", "", f.vehicles_present, 6));
    metrics.push_back(count_metric("max_present", "", f.max_present));
    const bool has_window = f.measured.window.length_s() > 0.0;
    metrics.push_back(number_metric("window_from", "s", has_window ? f.measured.window.from_s : none, 1));
    metrics.push_back(number_metric("window_to", "s", has_window ? f.measured.window.to_s : none, 1));
    metrics.push_back(number_metric("warm_up", "s", f.warm_up_s, 1));
    metrics.push_back({"stability", "", kStabilityNames[static_cast<std::size_t>(f.stability)]});
    metrics.push_back({"unstable_by", "", kInstabilityCauseNames[static_cast<std::size_t>(f.unstable_by)]});
    metrics.push_back(number_metric("collapse", "s", f.collapse_s.value_or(none), 1));
    metrics.push_back(count_metric("gridlocks", "", static_cast<std::int64_t>(delays.gridlocks.size())));
    metrics.push_back(
        number_metric("first_gridlock", "s", delays.gridlocks.empty() ? none : delays.gridlocks[0].from_s, 1));
    metrics.push_back(count_metric("starvations", "", static_cast<std::int64_t>(delays.starvations.size())));
    metrics.push_back(count_metric("teleported", "", delays.teleported));
    metrics.push_back(count_metric("passed_blockers", "", delays.passed_blockers));
    for (std::size_t cause = 1; cause < kDelayCauseNames.size(); ++cause) {
        metrics.push_back(
            number_metric(fmt::format("delay_{}", kDelayCauseNames[cause]), "h", delays.delay_s[cause] / 3600.0, 6));
    }
    metrics.push_back(number_metric("delay_upstream", "h", delays.delay_upstream_s / 3600.0, 6));
    metrics.push_back(count_metric("backlog", "", f.backlog));
    if (network_kind(scenario.network).reports_approaches) {
        for (RunMetric& metric : street_metrics(scenario, f)) metrics.push_back(std::move(metric));
    }
    metrics.push_back(number_metric("longest_stop", "s", delays.longest_stop_s, 1));
    metrics.push_back(number_metric("longest_in_junction", "s", f.longest_in_junction_s, 2));
    add_counts(f.entered, f.exited, f.violations, f.updates, f.state_hash, metrics);
    return metrics;
}

std::vector<RunMetric> network_metrics(const Scenario& scenario, std::size_t population,
                                       const std::function<bool()>& keep_going) {
    constexpr std::int64_t kProgressSteps = 200;
    const NetworkResult f = run_network(scenario, population, [&](const Simulation& simulation) {
        return !keep_going || simulation.state().tick % kProgressSteps != 0 || keep_going();
    });
    return f.complete ? metrics_of(scenario, f) : std::vector<RunMetric>{};
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
    return run_kind(scenario).metrics(scenario, population, keep_going);
}

namespace {

// Returns a result without data. Its lists have as many entries as the lists of a real run, so that metrics_of() gives
// the same columns.
NetworkResult empty_network_result(const Scenario& scenario) {
    NetworkResult none;
    if (network_kind(scenario.network).has_trips) return none;
    constexpr std::array kAllSides{Side::west, Side::south, Side::east, Side::north};
    for (const Side from : kAllSides) {
        for (const Side to : kAllSides) none.origin_destination.push_back({from, to, 0, 0.0});
    }
    if (!network_kind(scenario.network).reports_approaches) return none;
    for (const Approach& approach : make_network(scenario.network).approaches) {
        none.congestion.approaches.push_back({approach.name, {}});
    }
    return none;
}

std::vector<RunMetric> empty_network_metrics(const Scenario& scenario) {
    return metrics_of(scenario, empty_network_result(scenario));
}

std::vector<RunMetric> empty_intersection_metrics(const Scenario& scenario) {
    IntersectionResult none;
    none.zones.resize(scenario.measure.zone_radius_m.size());
    none.delay_s.resize(scenario.measure.zone_radius_m.size());
    return metrics_of(scenario, none);
}

std::vector<RunMetric> empty_approach_metrics(const Scenario& scenario) {
    PopulationSummary none;
    none.passed.resize(scenario.measure.green_s.size());
    return metrics_of(none, RunResult{});
}

TimeWindow whole_run(const Scenario& scenario) { return {0.0, scenario.duration_s}; }

TimeWindow end_of_run(const Scenario& scenario) {
    return {std::max(0.0, scenario.duration_s - scenario.measure.window_s), scenario.duration_s};
}

}  // namespace

extern const RunKind kSingleLightRun{"single_light", approach_metrics, empty_approach_metrics, whole_run};
extern const RunKind kIntersectionRun{"intersection", intersection_metrics, empty_intersection_metrics,
                                      measured_window};
extern const RunKind kNetworkRun{"network", network_metrics, empty_network_metrics, end_of_run};

std::vector<std::string> result_columns(const Scenario& scenario) {
    std::vector<std::string> columns;
    for (const RunMetric& metric : run_kind(scenario).empty_metrics(scenario)) columns.push_back(metric.column());
    return columns;
}

}  // namespace stopline
