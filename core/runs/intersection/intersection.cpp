#include "runs/intersection/intersection.h"

#include <algorithm>
#include <limits>

#include <fmt/format.h>

#include "base/io/csv.h"
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
    std::vector<std::string> columns{"population", "throughput_veh_h", "improvement_percent"};
    for (const double radius_m : report.scenario.measure.zone_radius_m) {
        for (const char* const format : {"travel_time_{:g}m_s", "delay_{:g}m_s", "density_{:g}m_percent"}) {
            columns.push_back(fmt::format(fmt::runtime(format), radius_m));
        }
    }
    for (const char* const column :
         {"density_network_percent", "vehicles_present", "vehicles_per_green", "saturated_greens",
          "saturation_flow_veh_h", "startup_lost_time_s", "queue_veh", "longest_queue_m", "turned_right_percent",
          "turned_left_percent", "longest_in_junction_s", "starvations", "overlaps", "conflicts", "red_entries",
          "forced_red_entries", "lost_vehicles", "deadlocks"}) {
        columns.emplace_back(column);
    }
    CsvWriter csv(columns);
    for (const IntersectionResult& f : report.populations) {
        std::vector<std::string> row{f.population, fixed(f.throughput_veh_h, 1),
                                     fixed(report.improvement_percent(f), 2)};
        for (std::size_t k = 0; k < f.zones.size(); ++k) {
            row.push_back(fixed(f.zones[k].travel_time_s, 3));
            row.push_back(fixed(f.delay_s[k], 3));
            row.push_back(fixed(100.0 * f.zones[k].occupied, 3));
        }
        const Violations& v = f.violations;
        for (const std::string& cell :
             {fixed(100.0 * f.occupied, 3), fixed(f.vehicles_present, 2), fixed(f.discharge.vehicles_per_green, 3),
              std::to_string(f.discharge.saturated_greens), fixed(f.discharge.saturation_flow_veh_h, 1),
              fixed(f.discharge.startup_lost_time_s, 3), fixed(f.queue_veh, 2), fixed(f.longest_queue_m, 2),
              fixed(100.0 * f.right_share, 2), fixed(100.0 * f.left_share, 2), fixed(f.longest_in_junction_s, 2),
              std::to_string(f.starvations.size()), std::to_string(v.overlaps), std::to_string(v.conflicts),
              std::to_string(v.red_entries), std::to_string(v.forced_red_entries), std::to_string(v.lost_vehicles),
              std::to_string(v.deadlocks)}) {
            row.push_back(cell);
        }
        csv.row(row);
    }
    return csv.text();
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
    for (const IntersectionResult& f : populations) all.push_back({f.population, f.starvations});
    return all;
}

}  // namespace stopline
