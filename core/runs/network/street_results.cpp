#include "runs/network/street_results.h"

#include <cmath>

#include <fmt/format.h>

#include "base/io/csv.h"
#include "base/nan.h"
#include "base/units.h"
#include "scenario/make_network.h"

namespace stopline {

namespace {

std::size_t index_of(Side side) { return static_cast<std::size_t>(side); }
std::size_t index_of(Turn turn) { return static_cast<std::size_t>(turn); }

// Returns the share of one movement among right, left and straight on, %; NaN if there is no vehicle.
double share_percent(const std::array<std::int64_t, kMaxTurns>& turned, Turn turn) {
    const std::int64_t all =
        turned[index_of(Turn::straight)] + turned[index_of(Turn::right)] + turned[index_of(Turn::left)];
    return all == 0 ? kNan : 100.0 * static_cast<double>(turned[index_of(turn)]) / static_cast<double>(all);
}

// Means over a period of the run. They are NaN if the run ends before the period ends.
struct PeriodMeans {
    double throughput_veh_h = kNan;
    double travel_time_s = kNan;
    double density_percent = kNan;
    std::array<double, 4> inflow_veh_h{kNan, kNan, kNan, kNan};
};

// Returns the means over all intervals that lie wholly between `from_s` and `to_s`.
PeriodMeans means_of(const NetworkResult& f, double interval_s, double from_s, double to_s) {
    PeriodMeans means;
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
    const double hours = intervals * interval_s / kSecondsPerHour;
    means.throughput_veh_h = exited / hours;
    means.travel_time_s = exited > 0.0 ? travel_s / exited : kNan;
    means.density_percent = 100.0 * occupied / intervals;
    for (std::size_t side = 0; side < inflow.size(); ++side) means.inflow_veh_h[side] = inflow[side] / hours;
    return means;
}

}  // namespace

std::string inflow_csv(const NetworkReport& report) {
    CsvWriter csv({"population", "from_s", "west_veh_h", "south_veh_h", "east_veh_h", "north_veh_h"});
    const double hours = report.scenario.measure.interval_s / kSecondsPerHour;
    for (const NetworkResult& f : report.populations) {
        for (std::size_t k = 0; k < f.inflow.size(); ++k) {
            std::vector<std::string> row{f.population, fixed(static_cast<double>(k) * hours * kSecondsPerHour, 0)};
            for (const int vehicles : f.inflow[k]) row.push_back(fixed(vehicles / hours, 1));
            csv.row(row);
        }
    }
    return csv.text();
}

std::string approaches_csv(const NetworkReport& report) {
    CsvWriter csv({"population", "approach", "from_s", "vehicles", "speed_kmh", "upstream_speed_kmh"});
    for (const NetworkResult& f : report.populations) {
        for (const ApproachSeries& approach : f.congestion.approaches) {
            for (std::size_t k = 0; k < approach.intervals.size(); ++k) {
                const ApproachInterval& interval = approach.intervals[k];
                csv.row({f.population, approach.name, fixed(static_cast<double>(k) * f.congestion.interval_s, 0),
                         fixed(interval.vehicles, 2), fixed(kKmhPerMps * interval.speed_mps, 2),
                         fixed(kKmhPerMps * interval.upstream_speed_mps, 2)});
            }
        }
    }
    return csv.text();
}

std::string turns_csv(const NetworkReport& report) {
    CsvWriter csv({"population", "approach", "vehicles", "right_percent", "right_target_percent", "left_percent",
                   "left_target_percent", "congested_from_s"});
    const LaneGraph graph = make_network(report.scenario.network);
    for (const NetworkResult& f : report.populations) {
        for (std::size_t k = 0; k < f.turn_counts.size(); ++k) {
            const Approach& approach = graph.approaches[k];
            const auto& turned = f.turn_counts[k];
            csv.row({f.population, approach.name,
                     std::to_string(turned[index_of(Turn::straight)] + turned[index_of(Turn::right)] +
                                    turned[index_of(Turn::left)]),
                     fixed(share_percent(turned, Turn::right), 2), fixed(100.0 * approach.right_share, 2),
                     fixed(share_percent(turned, Turn::left), 2), fixed(100.0 * approach.left_share, 2),
                     fixed(f.congestion.congested_from_s(k).value_or(kNan), 0)});
        }
    }
    return csv.text();
}

std::vector<RunMetric> street_metrics(const Scenario& scenario, const NetworkResult& result) {
    struct Period {
        const char* name;
        double from_s;
        double to_s;
    };
    std::vector<RunMetric> metrics;
    for (const Period& period : {Period{"early", 900.0, 3600.0}, Period{"late", 3900.0, 7200.0}}) {
        const PeriodMeans means = means_of(result, scenario.measure.interval_s, period.from_s, period.to_s);
        const auto add = [&](const std::string& name, const char* unit, double value) {
            metrics.push_back(number_metric(name + "_" + period.name, unit, value, 6));
        };
        add("throughput", "veh_h", means.throughput_veh_h);
        add("travel_time", "s", means.travel_time_s);
        add("density", "percent", means.density_percent);
        add("inflow_west", "veh_h", means.inflow_veh_h[index_of(Side::west)]);
        add("inflow_east", "veh_h", means.inflow_veh_h[index_of(Side::east)]);
        add("inflow_minor", "veh_h",
            means.inflow_veh_h[index_of(Side::south)] + means.inflow_veh_h[index_of(Side::north)]);
    }
    for (std::size_t k = 0; k < result.congestion.approaches.size(); ++k) {
        metrics.push_back(number_metric("congested_from_" + result.congestion.approaches[k].name, "s",
                                        result.congestion.congested_from_s(k).value_or(kNan), 0));
    }
    metrics.push_back(count_metric("mandatory_lane_changes", "", result.mandatory_lane_changes));
    metrics.push_back(count_metric("discretionary_lane_changes", "", result.discretionary_lane_changes));
    return metrics;
}

}  // namespace stopline
