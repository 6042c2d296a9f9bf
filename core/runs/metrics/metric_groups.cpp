#include "runs/metrics/metric_groups.h"

#include <algorithm>

#include "runs/intersection/intersection_metrics.h"
#include "runs/metrics/metric_tables.h"
#include "runs/network/network_metrics.h"
#include "runs/single_light/single_light_metrics.h"

namespace stopline {

namespace {

template <class Run, const MetricList<Run>& (*metrics)()>
MetricGroup group_of(std::string_view name, std::string_view title) {
    MetricGroup group{name, title, metric_docs(summary_columns(metrics(), nullptr)),
                      metric_docs(sweep_columns(metrics(), nullptr))};
    for (const Metric<Run>& metric : metrics()) {
        if (!metric.has_mean) group.no_mean.emplace_back(metric.column);
    }
    group.sweep_columns = [](const Scenario& scenario) { return sweep_column_names(metrics(), scenario); };
    group.list = [](const Scenario* scenario) { return listed_metrics(metrics(), scenario); };
    return group;
}

}  // namespace

const std::vector<MetricGroup>& metric_groups() {
    static const std::vector<MetricGroup> kGroups{
        group_of<MeasuredNetwork, network_metrics>("network", "grids, streets and imported networks"),
        group_of<MeasuredIntersection, intersection_metrics>("intersection", "single intersections"),
        group_of<MeasuredLight, single_light_metrics>("single_light", "single lights")};
    return kGroups;
}

const MetricGroup& metric_group(std::string_view name) {
    return *std::find_if(metric_groups().begin(), metric_groups().end(),
                         [&](const MetricGroup& group) { return group.name == name; });
}

const MetricGroup& metric_group_of(const NetworkSettings& network) { return metric_group(table_group(network)); }

bool has_mean(std::string_view column) {
    return std::none_of(metric_groups().begin(), metric_groups().end(), [&](const MetricGroup& group) {
        return std::find(group.no_mean.begin(), group.no_mean.end(), column) != group.no_mean.end();
    });
}

}  // namespace stopline
