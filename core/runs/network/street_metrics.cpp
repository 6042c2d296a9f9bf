// The metrics that only streets have. Some of them are means over two periods of the run, called stretches. In the
// paper, the queue on the corridor reaches the entries of the network between the two periods.
#include "base/nan.h"
#include "base/units.h"
#include "runs/network/network_metrics.h"
#include "scenario/kinds/network_kind.h"
#include "scenario/make_network.h"

namespace stopline {

namespace {

struct Stretch {
    const char* name;
    double from_s;
    double to_s;
};
constexpr std::array kStretches{Stretch{"early", 900.0, 3600.0}, Stretch{"late", 3900.0, 7200.0}};

std::vector<std::string> stretch_names(const Scenario&) {
    std::vector<std::string> names;
    for (const Stretch& stretch : kStretches) names.emplace_back(stretch.name);
    return names;
}
constexpr MetricFamily kStretchFamily{"STRETCH", stretch_names};

std::vector<std::string> approach_names(const Scenario& scenario) {
    std::vector<std::string> names;
    for (const Approach& approach : make_network(scenario.network).approaches) names.push_back(approach.name);
    return names;
}
constexpr MetricFamily kApproaches{"APPROACH", approach_names};

// Means over a stretch. They are NaN if the run ends before the stretch ends.
struct StretchMeans {
    double throughput_veh_h = kNan;
    double travel_time_s = kNan;
    double density_percent = kNan;
    std::array<double, 4> inflow_veh_h{kNan, kNan, kNan, kNan};
};

// Returns the means over all intervals that lie wholly in the stretch run.key.
StretchMeans means_of(const MeasuredNetwork& run) {
    const NetworkResult& f = run.result;
    const auto& [name, from_s, to_s] = kStretches[run.key];
    StretchMeans means;
    if (f.series.empty() || f.series.back().area.window.to_s < to_s) return means;
    double exited = 0.0;
    double travel_s = 0.0;
    double occupied = 0.0;
    std::array<double, 4> inflow{};
    int intervals = 0;
    for (std::size_t k = 0; k < f.series.size(); ++k) {
        const AreaResult& area = f.series[k].area;
        if (area.window.from_s < from_s || area.window.to_s > to_s) continue;
        ++intervals;
        exited += area.exited;
        if (area.exited > 0) travel_s += area.exited * area.travel_time_s;
        occupied += area.occupied;
        for (std::size_t side = 0; side < inflow.size(); ++side) inflow[side] += f.inflow[k][side];
    }
    const double hours = intervals * run.scenario.measure.interval_s / kSecondsPerHour;
    means.throughput_veh_h = exited / hours;
    means.travel_time_s = exited > 0.0 ? travel_s / exited : kNan;
    means.density_percent = 100.0 * occupied / intervals;
    for (std::size_t side = 0; side < inflow.size(); ++side) means.inflow_veh_h[side] = inflow[side] / hours;
    return means;
}

double inflow_veh_h(const MeasuredNetwork& run, Side side) {
    return means_of(run).inflow_veh_h[static_cast<std::size_t>(side)];
}

MetricList<MeasuredNetwork> stretch_metrics() {
    return {
        {.column = "throughput_STRETCH_veh_h",
         .unit = "veh/h",
         .extent = "stretch, area",
         .meaning = "streets: vehicles that leave the area in minutes 15 to 60 (`early`) and 65 to 120 (`late`); "
                    "empty if the run is shorter",
         .value = [](const MeasuredNetwork& run) { return means_of(run).throughput_veh_h; },
         .summary_decimals = kLeftOut,
         .family = &kStretchFamily},
        {.column = "travel_time_STRETCH_s",
         .unit = "s",
         .extent = "stretch, area",
         .meaning = "mean time of these vehicles in the area",
         .value = [](const MeasuredNetwork& run) { return means_of(run).travel_time_s; },
         .summary_decimals = kLeftOut,
         .family = &kStretchFamily},
        {.column = "density_STRETCH_percent",
         .unit = "%",
         .extent = "stretch, area",
         .meaning = "share of the lane length in the area that vehicles occupy",
         .value = [](const MeasuredNetwork& run) { return means_of(run).density_percent; },
         .summary_decimals = kLeftOut,
         .family = &kStretchFamily},
        {.column = "inflow_west_STRETCH_veh_h",
         .unit = "veh/h",
         .extent = "stretch, area",
         .meaning = "vehicles that enter the area from the west",
         .value = [](const MeasuredNetwork& run) { return inflow_veh_h(run, Side::west); },
         .summary_decimals = kLeftOut,
         .family = &kStretchFamily},
        {.column = "inflow_east_STRETCH_veh_h",
         .unit = "veh/h",
         .extent = "stretch, area",
         .meaning = "vehicles that enter the area from the east",
         .value = [](const MeasuredNetwork& run) { return inflow_veh_h(run, Side::east); },
         .summary_decimals = kLeftOut,
         .family = &kStretchFamily},
        {.column = "inflow_minor_STRETCH_veh_h",
         .unit = "veh/h",
         .extent = "stretch, area",
         .meaning = "vehicles that enter the area from the south and the north",
         .value =
             [](const MeasuredNetwork& run) { return inflow_veh_h(run, Side::south) + inflow_veh_h(run, Side::north); },
         .summary_decimals = kLeftOut,
         .family = &kStretchFamily},
    };
}

}  // namespace

MetricList<MeasuredNetwork> street_metrics() {
    MetricList<MeasuredNetwork> metrics = joined_lists<MeasuredNetwork>(
        {stretch_metrics(),
         {{.column = "congested_from_APPROACH_s",
           .unit = "s",
           .extent = "run",
           .meaning = "streets: as `congested_from_s` in `network/turns.csv`",
           .value =
               [](const MeasuredNetwork& run) {
                   return run.result.congestion.congested_from_s(run.key).value_or(kNan);
               },
           .summary_decimals = kLeftOut,
           .sweep_decimals = 0,
           .family = &kApproaches},
          {.column = "mandatory_lane_changes",
           .extent = "run",
           .meaning = "streets: lane changes because the route continues in another lane",
           .value = [](const MeasuredNetwork& run) { return run.result.mandatory_lane_changes; },
           .summary_decimals = kLeftOut},
          {.column = "discretionary_lane_changes",
           .extent = "run",
           .meaning = "streets: lane changes for a higher speed",
           .value = [](const MeasuredNetwork& run) { return run.result.discretionary_lane_changes; },
           .summary_decimals = kLeftOut}}});
    for (Metric<MeasuredNetwork>& metric : metrics) metric.only_for = &NetworkKind::reports_approaches;
    return metrics;
}

}  // namespace stopline
