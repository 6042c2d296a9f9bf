#include "runs/single_light/single_light_csv.h"

#include <fmt/format.h>

#include "base/io/csv.h"
#include "scenario/fleets.h"

namespace stopline {

namespace {

std::string policy_name(const SingleLightReport& result, std::size_t population, int policy) {
    return component_name(result.scenario.populations[population].components[static_cast<std::size_t>(policy)]);
}

std::vector<std::string> summary_row(const PopulationSummary& summary, const RunResult& run) {
    const SteadyFlow& steady = summary.steady;
    const Violations& violations = run.violations;
    return {summary.name,
            std::to_string(summary.counter.total()),
            fixed(summary.emptied_s, 3),
            std::to_string(steady.vehicles),
            std::to_string(steady.not_closed_up),
            fixed(steady.net_gap_m, 4),
            fixed(steady.policy_gap_m, 4),
            fixed(steady.headway_s, 5),
            fixed(steady.policy_headway_s, 5),
            fixed(steady.deviation_percent, 3),
            fixed(summary.asymptotic_improvement_percent, 2),
            fixed(summary.last_positions.headway_s, 4),
            fixed(summary.last_positions.speed_mps, 4),
            fixed(summary.leader.start_s, 2),
            fixed(summary.leader.duration_s(), 2),
            fixed(summary.queue.mean_m, 3),
            fixed(summary.queue.smallest_m, 3),
            fixed(summary.queue.largest_m, 3),
            std::to_string(run.vehicles_entered),
            std::to_string(run.vehicles_exited),
            std::to_string(violations.overlaps),
            std::to_string(violations.red_entries),
            std::to_string(violations.forced_red_entries),
            std::to_string(violations.lost_vehicles),
            fmt::format("{:016x}", run.state_hash)};
}

}  // namespace

std::string passages_csv(const SingleLightReport& result) {
    CsvWriter csv({"population", "lane", "position", "vehicle", "policy", "time_s", "headway_s", "speed_mps"});
    for (std::size_t k = 0; k < result.populations.size(); ++k) {
        for (const LinePassage& passage : result.populations[k].line) {
            csv.row({result.populations[k].name, std::to_string(passage.lane), std::to_string(passage.position),
                     std::to_string(passage.vehicle), policy_name(result, k, passage.policy), fixed(passage.time_s, 4),
                     fixed(passage.headway_s, 4), fixed(passage.speed_mps, 4)});
        }
    }
    return csv.text();
}

std::string summary_csv(const SingleLightReport& result) {
    CsvWriter csv({"population",
                   "passed_in_green_veh",
                   "queue_emptied_s",
                   "steady_vehicles",
                   "not_closed_up_vehicles",
                   "steady_net_gap_m",
                   "policy_gap_m",
                   "steady_headway_s",
                   "policy_headway_s",
                   "headway_deviation_percent",
                   "asymptotic_improvement_percent",
                   "last_ten_headway_s",
                   "last_ten_speed_mps",
                   "leader_start_s",
                   "leader_time_to_limit_s",
                   "queue_gap_mean_m",
                   "queue_gap_smallest_m",
                   "queue_gap_largest_m",
                   "vehicles_entered",
                   "vehicles_exited",
                   "overlaps",
                   "red_entries",
                   "forced_red_entries",
                   "lost_vehicles",
                   "state_hash"});
    for (std::size_t k = 0; k < result.populations.size(); ++k) {
        csv.row(summary_row(result.populations[k], result.runs[k]));
    }
    return csv.text();
}

std::string improvement_csv(const SingleLightReport& result) {
    CsvWriter csv({"population", "green_s", "passed_veh", "baseline", "baseline_passed_veh", "improvement_percent"});
    const std::vector<double>& green_s = result.scenario.measure.green_s;
    for (const PopulationSummary& summary : result.populations) {
        for (std::size_t k = 0; k < green_s.size(); ++k) {
            const PopulationSummary* const base = result.baseline ? &result.populations[*result.baseline] : nullptr;
            csv.row({summary.name, fixed(green_s[k], 3), std::to_string(summary.passed[k]), base ? base->name : "",
                     base ? std::to_string(base->passed[k]) : "", fixed(summary.improvement_percent[k], 2)});
        }
    }
    return csv.text();
}

std::string trajectories_csv(const SingleLightReport& result, double interval_s) {
    CsvWriter csv({"population", "time_s", "vehicle", "policy", "lane", "position_m", "speed_mps", "acceleration_mps2",
                   "request_mps2", "net_gap_m", "gear"});
    const double line_m = result.scenario.network.approach.length_m;
    for (std::size_t k = 0; k < result.runs.size(); ++k) {
        const RunResult& run = result.runs[k];
        for (const TrajectoryPoint& point : thin_out(run.trajectory, interval_s, result.scenario.tick_s())) {
            csv.row({run.population, fixed(point.time_s - run.green_start_s, 3), std::to_string(point.vehicle),
                     policy_name(result, k, point.policy), std::to_string(point.lane),
                     fixed(point.distance_m - line_m, 3), fixed(point.speed_mps, 4), fixed(point.acceleration_mps2, 4),
                     fixed(point.request_mps2, 4), fixed(point.net_gap_m, 4), std::to_string(point.gear)});
        }
    }
    return csv.text();
}

}  // namespace stopline
