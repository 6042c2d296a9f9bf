#include "runs/intersection/intersection_metrics.h"

#include "base/nan.h"
#include "runs/driving/energy_metrics.h"
#include "runs/driving/safety_metrics.h"
#include "runs/hcm/hcm_metrics.h"

namespace stopline {

namespace {

std::vector<std::string> zone_radii(const Scenario& scenario) {
    std::vector<std::string> radii;
    for (const double radius_m : scenario.measure.zone_radius_m) radii.push_back(fmt::format("{:g}", radius_m));
    return radii;
}
constexpr MetricFamily kZones{"RADIUS", zone_radii};

MetricList<MeasuredIntersection> zone_metrics() {
    return {
        {.column = "throughput_veh_h",
         .unit = "veh/h",
         .extent = "window",
         .meaning = "vehicles that leave the intersection",
         .value = [](const MeasuredIntersection& run) { return run.result.throughput_veh_h; },
         .summary_decimals = 1,
         .console = {.heading = "throughput", .decimals = 0, .note = "vehicles that leave the intersection"},
         .figure = {.sweep = {.change = "throughput gain over {} [%]"}}},
        {.column = "improvement_percent",
         .unit = "%",
         .extent = "window",
         .meaning = "gain in throughput over `measure.baseline`; empty without a baseline",
         .value =
             [](const MeasuredIntersection& run) {
                 return run.report == nullptr ? kNan : run.report->improvement_percent(run.result);
             },
         .summary_decimals = 2,
         .sweep_decimals = kLeftOut,
         .console = {.heading = "gain", .decimals = 0}},
        {.column = "travel_time_RADIUSm_s",
         .unit = "s",
         .extent = "window",
         .meaning = "mean time within this radius (`measure.zones`), over the vehicles that leave the circle",
         .value = [](const MeasuredIntersection& run) { return run.result.zones[run.key].travel_time_s; },
         .summary_decimals = 3,
         .family = &kZones,
         .console = {.heading = "time in RADIUS m",
                     .decimals = 1,
                     .note = "mean travel time from RADIUS m before the centre to RADIUS m behind it"},
         .figure = {.axis = "travel time, zone of RADIUS m"}},
        {.column = "delay_RADIUSm_s",
         .unit = "s",
         .extent = "window",
         .meaning = "`travel_time_RADIUSm_s` minus the travel time at the speed limit",
         .value = [](const MeasuredIntersection& run) { return run.result.delay_s[run.key]; },
         .summary_decimals = 3,
         .family = &kZones,
         .figure = {.axis = "delay, zone of RADIUS m"}},
        {.column = "density_RADIUSm_percent",
         .unit = "%",
         .extent = "window",
         .meaning = "share of the lane length within the radius that vehicles occupy",
         .value = [](const MeasuredIntersection& run) { return 100.0 * run.result.zones[run.key].occupied; },
         .summary_decimals = 3,
         .family = &kZones,
         .figure = {.axis = "density, zone of RADIUS m"}},
        {.column = "density_network_percent",
         .unit = "%",
         .extent = "window",
         .meaning = "share of the lane length of the whole network that vehicles occupy",
         .value = [](const MeasuredIntersection& run) { return 100.0 * run.result.occupied; },
         .summary_decimals = 3,
         .console = {.heading = "density", .decimals = 1, .note = "share of the lane length that vehicles occupy"},
         .figure = {.axis = "density"}},
        {.column = "vehicles_present",
         .unit = "veh",
         .extent = "window",
         .meaning = "mean number of vehicles in the network, sampled every second",
         .value = [](const MeasuredIntersection& run) { return run.result.vehicles_present; },
         .summary_decimals = 2,
         .console = {.heading = "vehicles", .decimals = 0, .note = "mean number on all lanes"}},
    };
}

MetricList<MeasuredIntersection> discharge_metrics() {
    return {
        {.column = "vehicles_per_green",
         .unit = "veh",
         .extent = "window",
         .meaning = "mean number of vehicles that pass a stop line in one green and its yellow",
         .value = [](const MeasuredIntersection& run) { return run.result.discharge.vehicles_per_green; },
         .summary_decimals = 3,
         .console = {.heading = "per green",
                     .decimals = 2,
                     .note = "vehicles that pass a stop line per lane in one green and its yellow"},
         .figure = {.axis = "vehicles per green and lane", .sweep = {.change = "vehicles gained over {} [%]"}}},
        {.column = "saturated_greens",
         .extent = "window",
         .meaning = "number of greens, summed over the lanes, in which five or more vehicles of a queue pass. Only "
                    "vehicles that were slower than 5 km/h before the stop line are of the queue, and it ends before "
                    "the first other vehicle",
         .value = [](const MeasuredIntersection& run) { return run.result.discharge.saturated_greens; }},
        {.column = "saturation_flow_veh_h",
         .unit = "veh/h",
         .extent = "window",
         .meaning = "flow at the mean headway from the fifth vehicle of a queue on; empty: no saturated green",
         .value = [](const MeasuredIntersection& run) { return run.result.discharge.saturation_flow_veh_h; },
         .summary_decimals = 1,
         .sweep_decimals = kLeftOut,
         .console = {.heading = "saturation",
                     .decimals = 0,
                     .note = "flow from the fifth vehicle of a queue on; only queued vehicles count"}},
        {.column = "saturation_headway_s",
         .unit = "s",
         .extent = "window",
         .meaning = "mean headway from the fifth vehicle of a queue on; empty: no saturated green",
         .value = [](const MeasuredIntersection& run) { return run.result.discharge.saturation_headway_s; },
         .summary_decimals = kLeftOut},
        {.column = "startup_lost_time_s",
         .unit = "s",
         .extent = "window",
         .meaning = "sum over the first four vehicles of a queue: headway minus the mean headway of the lane from the "
                    "fifth vehicle on; mean over saturated greens",
         .value = [](const MeasuredIntersection& run) { return run.result.discharge.startup_lost_time_s; },
         .summary_decimals = 3,
         .console = {.heading = "lost time",
                     .decimals = 1,
                     .note = "start-up lost time of the first four vehicles of a queue"}},
        {.column = "queue_veh",
         .unit = "veh",
         .extent = "window",
         .meaning = "queued vehicles at the start of green, mean over lanes and greens",
         .value = [](const MeasuredIntersection& run) { return run.result.queue_veh; },
         .summary_decimals = 2,
         .console = {.heading = "queue", .decimals = 1, .note = "stopped vehicles per lane when its green starts"},
         .figure = {.axis = "queue at the start of green",
                    .sweep = {.change = "queue saved against {} [%]", .better = Better::lower}}},
        {.column = "longest_queue_m",
         .unit = "m",
         .extent = "window",
         .meaning = "longest of these queues",
         .value = [](const MeasuredIntersection& run) { return run.result.longest_queue_m; },
         .summary_decimals = 2},
        {.column = "turned_right_percent",
         .unit = "%",
         .extent = "window",
         .meaning = "share of the vehicles that leave the intersection to the right",
         .value = [](const MeasuredIntersection& run) { return 100.0 * run.result.right_share; },
         .summary_decimals = 2},
        {.column = "turned_left_percent",
         .unit = "%",
         .extent = "window",
         .meaning = "share of the vehicles that leave the intersection to the left",
         .value = [](const MeasuredIntersection& run) { return 100.0 * run.result.left_share; },
         .summary_decimals = 2},
        {.column = "gaps_accepted",
         .extent = "run",
         .meaning = "gaps that left-turning vehicles accepted",
         .value = [](const MeasuredIntersection& run) { return run.result.gaps_accepted; },
         .summary_decimals = kLeftOut},
    };
}

MetricList<MeasuredIntersection> junction_metrics() {
    Metric<MeasuredIntersection> junction_time = junction_time_metric<MeasuredIntersection>(2);
    junction_time.sweep_after = "starvations";
    return {junction_time, starvations_metric<MeasuredIntersection>()};
}

}  // namespace

const MetricList<MeasuredIntersection>& intersection_metrics() {
    static const MetricList<MeasuredIntersection> kMetrics = joined_lists<MeasuredIntersection>(
        {zone_metrics(),
         discharge_metrics(),
         junction_metrics(),
         count_metrics<MeasuredIntersection>(
             {"overlaps", "conflicts", "red_entries", "forced_red_entries", "lost_vehicles", "deadlocks"}),
         departure_metrics<MeasuredIntersection>(),
         {backlog_metric<MeasuredIntersection>()},
         energy_metrics<MeasuredIntersection>(),
         safety_metrics<MeasuredIntersection>(),
         hcm_metrics<MeasuredIntersection>()});
    return kMetrics;
}

std::vector<MeasuredIntersection> measured_runs(const IntersectionReport& report) {
    std::vector<MeasuredIntersection> runs;
    for (const IntersectionResult& result : report.populations) runs.push_back({report.scenario, result, &report});
    return runs;
}

}  // namespace stopline
