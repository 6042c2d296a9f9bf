#include "runs/intersection/intersection.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "base/io/csv.h"
#include "runs/intersection/intersection_metrics.h"
#include "runs/metrics/metric_tables.h"
#include "runs/parallel_runs.h"
#include "scenario/build_model.h"
#include "scenario/make_network.h"

namespace stopline {

double IntersectionReport::improvement_percent(const IntersectionResult& result) const {
    for (const IntersectionResult& baseline : populations) {
        if (baseline.population != scenario.measure.baseline) continue;
        return 100.0 * (result.throughput_veh_h / baseline.throughput_veh_h - 1.0);
    }
    return std::numeric_limits<double>::quiet_NaN();
}

bool IntersectionReport::no_starvation() const {
    return std::all_of(populations.begin(), populations.end(),
                       [](const IntersectionResult& f) { return f.starvations.empty(); });
}

bool IntersectionReport::no_violations() const {
    return std::all_of(populations.begin(), populations.end(),
                       [](const IntersectionResult& f) { return f.violations.none(); });
}

IntersectionReport run_intersections(const Scenario& scenario, const IntersectionOptions& options) {
    constexpr std::int64_t kProgressSteps = 1000;
    const std::size_t runs = scenario.populations.size();
    IntersectionReport report{scenario, std::vector<IntersectionResult>(runs), {}, {}};
    for (const Lane& lane : make_network(scenario.network).lanes) report.lanes.push_back(lane.name);
    report.trajectories.resize(runs);
    const TimeWindow traced_window = first_cycle(scenario);
    const std::int64_t sample_ticks = to_ticks(options.trajectory_interval_s, scenario.tick_s());
    const auto trace = [&](const Simulation& simulation, std::vector<TrajectoryPoint>& points) {
        if (sample_ticks < 1 || simulation.state().tick % sample_ticks != 0) return;
        if (simulation.time_s() >= traced_window.from_s && simulation.time_s() < traced_window.to_s)
            sample_vehicles(simulation, points);
    };
    const double end_s = measured_window(scenario).to_s;
    run_side_by_side(runs, options.threads, options.on_progress,
                     [&](std::size_t k, const std::function<bool(double)>& report_progress) {
                         const auto on_step = [&](const Simulation& simulation) {
                             trace(simulation, report.trajectories[k]);
                             return simulation.state().tick % kProgressSteps != 0 ||
                                    report_progress(simulation.time_s() / end_s);
                         };
                         report.populations[k] = run_intersection(scenario, k, on_step, options.observation);
                     });
    return report;
}

std::string intersection_csv(const IntersectionReport& report) {
    return metrics_csv(intersection_metrics(), report.scenario, measured_runs(report));
}

std::string intersection_trajectories_csv(const IntersectionReport& report) {
    CsvWriter csv({"population", "time_s", "vehicle", "policy", "lane", "position_m", "x_m", "y_m", "speed_mps",
                   "acceleration_mps2", "request_mps2", "net_gap_m", "gear"});
    for (std::size_t k = 0; k < report.populations.size(); ++k) {
        const Model model = build_model(report.scenario, k);
        for (const TrajectoryPoint& point : report.trajectories[k]) {
            const auto lane = static_cast<std::size_t>(point.lane);
            const Lane& road = model.graph.lanes[lane];
            const Point front = pose_at(road.shape, road.shape_start_m + point.position_m).point;
            csv.row({report.populations[k].population, fixed(point.time_s, 3), std::to_string(point.vehicle),
                     model.policies[static_cast<std::size_t>(point.policy)].settings.name, road.name,
                     fixed(point.distance_m, 3), fixed(front.x_m, 3), fixed(front.y_m, 3), fixed(point.speed_mps, 4),
                     fixed(point.acceleration_mps2, 4), fixed(point.request_mps2, 4), fixed(point.net_gap_m, 4),
                     std::to_string(point.gear)});
        }
    }
    return csv.text();
}

std::string headways_csv(const IntersectionReport& report) {
    CsvWriter csv({"population", "lane", "position", "headway_s", "samples"});
    for (const IntersectionResult& f : report.populations) {
        for (const LaneDischarge& lane : f.discharge.lanes) {
            for (std::size_t k = 0; k < lane.headway_s.size(); ++k) {
                csv.row({f.population, lane.lane, std::to_string(k + 1), fixed(lane.headway_s[k], 4),
                         std::to_string(lane.samples[k])});
            }
        }
    }
    return csv.text();
}

std::vector<PopulationStarvations> IntersectionReport::starvations() const {
    std::vector<PopulationStarvations> all;
    for (const IntersectionResult& f : populations) all.push_back({f.population, f.starvations, f.vehicle_names});
    return all;
}

}  // namespace stopline
