#include "experiment/street_results.h"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "experiment/csv.h"

namespace stopline {

namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr double kHour_s = 3600.0;
constexpr double kKmh = 3.6;  // per m/s

std::size_t of(Side side) { return static_cast<std::size_t>(side); }
std::size_t of(Turn turn) { return static_cast<std::size_t>(turn); }

double share_percent(const std::array<std::int64_t, kMostTurns>& turned, Turn turn) {
    const std::int64_t all = turned[of(Turn::straight)] + turned[of(Turn::right)] + turned[of(Turn::left)];
    return all == 0 ? kNone : 100.0 * static_cast<double>(turned[of(turn)]) / static_cast<double>(all);
}

// Means over the intervals that begin in a stretch of time, if the run covers it.
struct StretchMeans {
    double throughput_veh_h = kNone;
    double travel_time_s = kNone;
    double density_percent = kNone;
    std::array<double, 4> inflow_veh_h{kNone, kNone, kNone, kNone};
};

StretchMeans means_of(const NetworkFigures& f, double interval_s, double from_s, double to_s) {
    StretchMeans means;
    if (f.series.empty() || f.series.back().area.window.to_s < to_s) return means;
    double left = 0.0;
    double travel_s = 0.0;
    double occupied = 0.0;
    std::array<double, 4> inflow{};
    int intervals = 0;
    for (std::size_t k = 0; k < f.series.size(); ++k) {
        const AreaFigures& area = f.series[k].area;
        if (area.window.from_s < from_s || area.window.to_s > to_s) continue;
        ++intervals;
        left += area.left;
        if (area.left > 0) travel_s += area.left * area.travel_time_s;
        occupied += area.occupied;
        for (std::size_t side = 0; side < inflow.size(); ++side) inflow[side] += f.inflow[k][side];
    }
    const double hours = intervals * interval_s / kHour_s;
    means.throughput_veh_h = left / hours;
    means.travel_time_s = left > 0.0 ? travel_s / left : kNone;
    means.density_percent = 100.0 * occupied / intervals;
    for (std::size_t side = 0; side < inflow.size(); ++side) means.inflow_veh_h[side] = inflow[side] / hours;
    return means;
}

}  // namespace

std::string inflow_csv(const NetworkReport& report) {
    CsvWriter csv({"population", "from_s", "west_veh_h", "south_veh_h", "east_veh_h", "north_veh_h"});
    const double hours = report.scenario.measure.interval_s / kHour_s;
    for (const NetworkFigures& f : report.populations) {
        for (std::size_t k = 0; k < f.inflow.size(); ++k) {
            std::vector<std::string> row{f.population, fixed(static_cast<double>(k) * hours * kHour_s, 0)};
            for (const int vehicles : f.inflow[k]) row.push_back(fixed(vehicles / hours, 1));
            csv.row(row);
        }
    }
    return csv.text();
}

std::string approaches_csv(const NetworkReport& report) {
    CsvWriter csv({"population", "approach", "from_s", "vehicles", "speed_kmh", "upstream_speed_kmh"});
    for (const NetworkFigures& f : report.populations) {
        for (const ApproachSeries& approach : f.backlog.approaches) {
            for (std::size_t k = 0; k < approach.intervals.size(); ++k) {
                const ApproachInterval& each = approach.intervals[k];
                csv.row({f.population, approach.name, fixed(static_cast<double>(k) * f.backlog.interval_s, 0),
                         fixed(each.vehicles, 2), fixed(kKmh * each.speed_mps, 2),
                         fixed(kKmh * each.upstream_speed_mps, 2)});
            }
        }
    }
    return csv.text();
}

std::string turns_csv(const NetworkReport& report) {
    CsvWriter csv({"population", "approach", "vehicles", "right_percent", "right_asked_percent", "left_percent",
                   "left_asked_percent", "filled_s"});
    const LaneGraph graph = make_network(report.scenario.network);
    for (const NetworkFigures& f : report.populations) {
        for (std::size_t k = 0; k < f.turned.size(); ++k) {
            const Approach& approach = graph.approaches[k];
            const auto& turned = f.turned[k];
            csv.row({f.population, approach.name,
                     std::to_string(turned[of(Turn::straight)] + turned[of(Turn::right)] + turned[of(Turn::left)]),
                     fixed(share_percent(turned, Turn::right), 2), fixed(100.0 * approach.right, 2),
                     fixed(share_percent(turned, Turn::left), 2), fixed(100.0 * approach.left, 2),
                     fixed(f.backlog.filled_s(k).value_or(kNone), 0)});
        }
    }
    return csv.text();
}

std::vector<RunMetric> street_metrics(const Scenario& scenario, const NetworkFigures& f) {
    struct Stretch {
        const char* name;
        double from_s;
        double to_s;
    };
    std::vector<RunMetric> metrics;
    for (const Stretch& stretch : {Stretch{"early", 900.0, 3600.0}, Stretch{"late", 3900.0, 7200.0}}) {
        const StretchMeans means = means_of(f, scenario.measure.interval_s, stretch.from_s, stretch.to_s);
        const auto add = [&](const std::string& name, const char* unit, double value) {
            metrics.push_back(number_metric(name + "_" + stretch.name, unit, value, 6));
        };
        add("throughput", "veh_h", means.throughput_veh_h);
        add("travel_time", "s", means.travel_time_s);
        add("density", "percent", means.density_percent);
        add("inflow_west", "veh_h", means.inflow_veh_h[of(Side::west)]);
        add("inflow_east", "veh_h", means.inflow_veh_h[of(Side::east)]);
        add("inflow_minor", "veh_h", means.inflow_veh_h[of(Side::south)] + means.inflow_veh_h[of(Side::north)]);
    }
    for (std::size_t k = 0; k < f.backlog.approaches.size(); ++k) {
        metrics.push_back(
            number_metric("filled_" + f.backlog.approaches[k].name, "s", f.backlog.filled_s(k).value_or(kNone), 0));
    }
    metrics.push_back(count_metric("changes_for_route", "", f.changes_for_route));
    metrics.push_back(count_metric("changes_for_speed", "", f.changes_for_speed));
    return metrics;
}

}  // namespace stopline
