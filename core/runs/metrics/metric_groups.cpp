#include "runs/metrics/metric_groups.h"

#include <algorithm>

#include <fmt/format.h>

#include "runs/intersection/intersection_metrics.h"
#include "runs/metrics/metric_tables.h"
#include "runs/network/network_metrics.h"
#include "runs/single_light/single_light_metrics.h"
#include "scenario/kinds/network_kind.h"

namespace stopline {

namespace {

template <class Run, const MetricList<Run>& (*metrics)()>
MetricGroup group_of(std::string_view name, std::string_view title) {
    MetricGroup group;
    group.name = name;
    group.title = title;
    group.summary = metric_docs(summary_columns(metrics(), nullptr));
    group.sweep = metric_docs(sweep_columns(metrics(), nullptr));
    for (const Metric<Run>& metric : metrics()) {
        if (!metric.has_mean) group.no_mean.emplace_back(metric.column);
    }
    group.drawn = drawn_metrics(metrics());
    group.sweep_columns = [](const Scenario& scenario) { return sweep_column_names(metrics(), scenario); };
    group.list = [](const Scenario* scenario) { return listed_metrics(metrics(), scenario); };
    return group;
}

}  // namespace

const std::vector<MetricGroup>& metric_groups() {
    static const std::vector<MetricGroup> kGroups{
        group_of<MeasuredNetwork, network_metrics>(kRunAsNetwork, "grids, streets and imported networks"),
        group_of<MeasuredIntersection, intersection_metrics>(kRunAsIntersection, "single intersections"),
        group_of<MeasuredLight, single_light_metrics>(kRunAsSingleLight, "single lights")};
    return kGroups;
}

const MetricGroup& metric_group(std::string_view name) {
    return *std::find_if(metric_groups().begin(), metric_groups().end(),
                         [&](const MetricGroup& group) { return group.name == name; });
}

const MetricGroup& metric_group_of(const NetworkSettings& network) { return metric_group(table_group(network)); }

bool DrawnMetric::has(std::string_view name) const {
    if (placeholder.empty()) return name == column;
    return !key_in(name, column, placeholder).empty();
}

std::string DrawnMetric::axis(std::string_view name) const {
    if (figure.axis.empty()) return with_key(without_unit(name, unit), "_", " ");
    return placeholder.empty() ? std::string(figure.axis)
                               : with_key(figure.axis, placeholder, key_in(name, column, placeholder));
}

std::string axis_title(std::string_view column) {
    const auto key_size = [&](const DrawnMetric& metric) {
        return metric.placeholder.empty() ? 0 : key_in(column, metric.column, metric.placeholder).size();
    };
    // The metric with the shortest key fits best: travel_time_94m_s is travel_time_RADIUSm_s, not
    // travel_time_STRETCH_s.
    const DrawnMetric* best = nullptr;
    for (const MetricGroup& group : metric_groups()) {
        for (const DrawnMetric& metric : group.drawn) {
            if (metric.has(column) && (best == nullptr || key_size(metric) < key_size(*best))) best = &metric;
        }
    }
    if (best == nullptr) return std::string(column);
    return best->axis(column) + (best->unit.empty() ? "" : fmt::format(" [{}]", best->unit));
}

bool has_mean(std::string_view column) {
    return std::none_of(metric_groups().begin(), metric_groups().end(), [&](const MetricGroup& group) {
        return std::find(group.no_mean.begin(), group.no_mean.end(), column) != group.no_mean.end();
    });
}

}  // namespace stopline
