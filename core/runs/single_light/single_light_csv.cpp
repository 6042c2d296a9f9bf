#include "runs/single_light/single_light_csv.h"

#include "base/io/csv.h"
#include "runs/metrics/metric_tables.h"
#include "runs/single_light/single_light_metrics.h"
#include "scenario/fleets.h"

namespace stopline {

namespace {

std::string policy_name(const SingleLightReport& result, std::size_t population, int policy) {
    return component_name(result.scenario.populations[population].components[static_cast<std::size_t>(policy)]);
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
    return metrics_csv(single_light_metrics(), result.scenario, measured_runs(result));
}

std::string improvement_csv(const SingleLightReport& result) {
    return metrics_csv(green_metrics(), result.scenario, measured_greens(result));
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
