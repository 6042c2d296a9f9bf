#include "experiment/run_metrics.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>

#include "base/input_error.h"
#include "experiment/csv.h"
#include "experiment/intersection_run.h"
#include "experiment/network_run.h"
#include "experiment/single_light.h"
#include "experiment/street_results.h"
#include "sim/model.h"

namespace stopline {

namespace {

// A whole number of steps of about kSampleInterval_s.
double sample_interval_s(const Scenario& scenario) {
    const std::int64_t ticks = std::max<std::int64_t>(1, to_ticks(kSampleInterval_s, scenario.tick_s()));
    return static_cast<double>(ticks) * scenario.tick_s();
}

void add_counts(std::int64_t entered, std::int64_t left, const Violations& violations, std::int64_t updates,
                std::uint64_t state_hash, std::vector<RunMetric>& metrics) {
    metrics.push_back(count_metric("vehicles_entered", "", entered));
    metrics.push_back(count_metric("vehicles_left", "", left));
    metrics.push_back(count_metric("overlaps", "", violations.overlaps + violations.conflicts));
    metrics.push_back(count_metric("red_entries", "", violations.red_entries));
    metrics.push_back(count_metric("forced_red_entries", "", violations.forced_red_entries));
    metrics.push_back(count_metric("lost_vehicles", "", violations.lost_vehicles));
    metrics.push_back(count_metric("deadlocks", "", violations.deadlocks));
    metrics.push_back(count_metric("updates", "", updates));
    metrics.push_back({"state_hash", "", fmt::format("{:016x}", state_hash)});
}

// The queue at a single light: what summary.csv of stopline-run holds too.
std::vector<RunMetric> metrics_of(const PopulationSummary& summary, const RunResult& run) {
    std::vector<RunMetric> metrics;
    for (std::size_t k = 0; k < summary.passed.size(); ++k) {
        metrics.push_back(count_metric(fmt::format("passed_{}", k + 1), "veh", summary.passed[k]));
    }
    metrics.push_back(number_metric("emptied", "s", summary.emptied_s, 6));
    metrics.push_back(count_metric("settled", "veh", summary.settled.vehicles));
    metrics.push_back(number_metric("settled_headway", "s", summary.settled.headway_s, 6));
    metrics.push_back(number_metric("settled_net_gap", "m", summary.settled.net_gap_m, 6));
    add_counts(run.vehicles_entered, run.vehicles_left, run.violations, run.updates, run.state_hash, metrics);
    return metrics;
}

std::vector<RunMetric> approach_metrics(const Scenario& scenario, std::size_t population,
                                        const std::function<bool()>& keep_going) {
    RunOptions options;
    options.trajectory_interval_s = sample_interval_s(scenario);
    options.trajectory_from_s = scenario.signal.first_green_s - kLeadIn_s;
    options.trajectory_until_s = scenario.signal.first_green_s + scenario.signal.green_s + kLeadOut_s;
    options.on_progress = [&](double) { return !keep_going || keep_going(); };
    const RunResult run = run_population(scenario, population, options);
    if (!run.complete) return {};
    return metrics_of(summary_of(scenario, population, run, run.trajectory, options.trajectory_interval_s), run);
}

std::vector<RunMetric> metrics_of(const Scenario& scenario, const IntersectionFigures& f) {
    std::vector<RunMetric> metrics;
    metrics.push_back(number_metric("throughput", "veh_h", f.throughput_veh_h, 6));
    for (std::size_t k = 0; k < f.zones.size(); ++k) {
        const std::string zone = fmt::format("_{:g}m", scenario.measure.zone_radius_m[k]);
        metrics.push_back(number_metric("travel_time" + zone, "s", f.zones[k].travel_time_s, 6));
        metrics.push_back(number_metric("delay" + zone, "s", f.delay_s[k], 6));
        metrics.push_back(number_metric("density" + zone, "percent", 100.0 * f.zones[k].occupied, 6));
    }
    metrics.push_back(number_metric("density_network", "percent", 100.0 * f.occupied, 6));
    metrics.push_back(number_metric("vehicles_present", "veh", f.vehicles_present, 6));
    metrics.push_back(number_metric("vehicles_per_green", "veh", f.discharge.vehicles_per_green, 6));
    metrics.push_back(number_metric("saturation_headway", "s", f.discharge.saturation_headway_s, 6));
    metrics.push_back(number_metric("lost_time", "s", f.discharge.lost_time_s, 6));
    metrics.push_back(number_metric("queue", "veh", f.queue_veh, 6));
    metrics.push_back(number_metric("longest_queue", "m", f.longest_queue_m, 6));
    metrics.push_back(number_metric("turned_right", "percent", 100.0 * f.right, 6));
    metrics.push_back(number_metric("turned_left", "percent", 100.0 * f.left, 6));
    metrics.push_back(count_metric("gaps_accepted", "", f.gaps_accepted));
    metrics.push_back(number_metric("longest_inside", "s", f.longest_inside_s, 2));
    add_counts(f.entered, f.left_network, f.violations, f.updates, f.state_hash, metrics);
    return metrics;
}

std::vector<RunMetric> intersection_metrics(const Scenario& scenario, std::size_t population,
                                            const std::function<bool()>& keep_going) {
    constexpr std::int64_t kAsk = 1000;  // steps
    const IntersectionFigures f = run_intersection(scenario, population, [&](const Simulation& simulation) {
        return !keep_going || simulation.state().tick % kAsk != 0 || keep_going();
    });
    return f.complete ? metrics_of(scenario, f) : std::vector<RunMetric>{};
}

std::vector<RunMetric> metrics_of(const Scenario& scenario, const NetworkFigures& f) {
    const HindranceLog& log = f.hindrance;
    const double none = std::numeric_limits<double>::quiet_NaN();
    std::vector<RunMetric> metrics;
    metrics.push_back(number_metric("throughput", "veh_h", f.steady.throughput_veh_h(), 6));
    metrics.push_back(number_metric("travel_time", "s", f.steady.travel_time_s, 6));
    metrics.push_back(number_metric("density", "percent", 100.0 * f.steady.occupied, 6));
    for (const WayFigures& way : f.ways) {
        const int across = std::abs(static_cast<int>(way.from) - static_cast<int>(way.to));
        if (across != 2) continue;
        const std::string name = fmt::format("{}_{}", kSideNames[static_cast<std::size_t>(way.from)],
                                             kSideNames[static_cast<std::size_t>(way.to)]);
        metrics.push_back(
            number_metric("throughput_" + name, "veh_h", way.left * 3600.0 / f.steady.window.length_s(), 6));
        metrics.push_back(number_metric("travel_time_" + name, "s", way.travel_time_s, 6));
    }
    metrics.push_back(number_metric("vehicles_in_area", "veh", f.steady.vehicles, 6));
    metrics.push_back(number_metric("vehicles_present", "veh", f.vehicles_present, 6));
    metrics.push_back(count_metric("most_present", "veh", f.most_present));
    const bool measured = f.steady.window.length_s() > 0.0;
    metrics.push_back(number_metric("window_from", "s", measured ? f.steady.window.from_s : none, 1));
    metrics.push_back(number_metric("window_to", "s", measured ? f.steady.window.to_s : none, 1));
    metrics.push_back(number_metric("warm_up", "s", f.warm_up_s, 1));
    metrics.push_back({"stability", "", kStabilityNames[static_cast<std::size_t>(f.stability)]});
    metrics.push_back({"unstable_by", "", kBreakdownNames[static_cast<std::size_t>(f.breakdown)]});
    metrics.push_back(number_metric("collapse", "s", f.collapse_s.value_or(none), 1));
    metrics.push_back(count_metric("gridlocks", "", static_cast<std::int64_t>(log.gridlocks.size())));
    metrics.push_back(number_metric("first_gridlock", "s", log.gridlocks.empty() ? none : log.gridlocks[0].from_s, 1));
    metrics.push_back(count_metric("moved_on", "", log.taken_out));
    metrics.push_back(count_metric("passed_blockers", "", log.passed_blockers));
    for (std::size_t cause = 1; cause < kCauseNames.size(); ++cause) {
        metrics.push_back(
            number_metric(fmt::format("lost_{}", kCauseNames[cause]), "h", log.lost_s[cause] / 3600.0, 6));
    }
    metrics.push_back(number_metric("lost_outside", "h", log.lost_outside_s / 3600.0, 6));
    metrics.push_back(count_metric("waiting", "veh", f.waiting));
    if (scenario.network.is_streets()) {
        for (RunMetric& metric : street_metrics(scenario, f)) metrics.push_back(std::move(metric));
    }
    metrics.push_back(number_metric("longest_stand", "s", log.longest_stand_s, 1));
    metrics.push_back(number_metric("longest_inside", "s", f.longest_inside_s, 2));
    add_counts(f.entered, f.left_network, f.violations, f.updates, f.state_hash, metrics);
    return metrics;
}

std::vector<RunMetric> network_metrics(const Scenario& scenario, std::size_t population,
                                       const std::function<bool()>& keep_going) {
    constexpr std::int64_t kAsk = 200;  // steps
    const NetworkFigures f = run_network(scenario, population, [&](const Simulation& simulation) {
        return !keep_going || simulation.state().tick % kAsk != 0 || keep_going();
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
    if (scenario.network.has_several()) return network_metrics(scenario, population, keep_going);
    if (scenario.network.kind == "intersection") return intersection_metrics(scenario, population, keep_going);
    return approach_metrics(scenario, population, keep_going);
}

namespace {

// Figures of no run, with all that the scenario's runs have an entry for.
NetworkFigures no_network_figures(const Scenario& scenario) {
    NetworkFigures none;
    if (scenario.network.is_sumo()) return none;
    constexpr std::array kAllSides{Side::west, Side::south, Side::east, Side::north};
    for (const Side from : kAllSides) {
        for (const Side to : kAllSides) none.ways.push_back({from, to, 0, 0.0});
    }
    if (!scenario.network.is_streets()) return none;
    for (const Approach& approach : make_network(scenario.network).approaches) {
        none.backlog.approaches.push_back({approach.name, {}});
    }
    return none;
}

std::vector<RunMetric> metrics_of_no_run(const Scenario& scenario) {
    if (scenario.network.has_several()) return metrics_of(scenario, no_network_figures(scenario));
    if (scenario.network.kind == "intersection") {
        IntersectionFigures none;
        none.zones.resize(scenario.measure.zone_radius_m.size());
        none.delay_s.resize(scenario.measure.zone_radius_m.size());
        return metrics_of(scenario, none);
    }
    PopulationSummary none;
    none.passed.resize(scenario.measure.green_s.size());
    return metrics_of(none, RunResult{});
}

}  // namespace

std::vector<std::string> result_columns(const Scenario& scenario) {
    std::vector<std::string> columns;
    for (const RunMetric& metric : metrics_of_no_run(scenario)) columns.push_back(metric.column());
    return columns;
}

}  // namespace stopline
