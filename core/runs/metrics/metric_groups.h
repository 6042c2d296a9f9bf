// The metrics of all kinds of networks, for lists and documentation.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "runs/metrics/metric.h"
#include "runs/metrics/metric_text.h"
#include "runs/tables/column_docs.h"
#include "scenario/scenario.h"

namespace stopline {

// A metric as figures show it. The figures of a sweep have only the table of results, not the scenario. They read the
// key of a family from the name of the column.
struct DrawnMetric {
    std::string_view column;       // as in Metric
    std::string_view placeholder;  // that of the family; empty: the metric has no family
    std::string_view unit;
    MetricFigure figure;
    bool is_optional = false;  // only scenarios that ask for the metric have it

    // Returns true if the metric has the column, such as travel_time_94m_s.
    bool has(std::string_view name) const;
    // Returns the name on axes for one of the columns of the metric, such as "travel time".
    std::string axis(std::string_view name) const;
};

// The metrics of one way of running (runs/run_kind.h).
struct MetricGroup {
    std::string_view name;             // group of the tables, as in column_docs.h
    std::string_view title;            // kinds of networks that are run in this way, in words
    std::vector<ColumnDoc> summary;    // columns of summary.csv after `population`
    std::vector<ColumnDoc> sweep;      // columns of sweeps after the seed
    std::vector<DrawnMetric> drawn;    // all metrics in CSV tables
    std::vector<std::string> no_mean;  // columns of sweeps whose means over seeds have no meaning
    // Returns the names of the columns of sweeps, after the seed.
    std::vector<std::string> (*sweep_columns)(const Scenario& scenario) = nullptr;
    // Returns the metrics for stopline-run --list. A null `scenario` gives those of all scenarios.
    std::vector<ListedMetric> (*list)(const Scenario* scenario) = nullptr;
};

// Returns all groups, in the order of scenarios/COLUMNS.md.
const std::vector<MetricGroup>& metric_groups();

// Return the group with this name, and the group of a network. The group must exist.
const MetricGroup& metric_group(std::string_view name);
const MetricGroup& metric_group_of(const NetworkSettings& network);

// Returns the title of an axis for a column of summary.csv or of a sweep, such as "travel time [s]". If no metric has
// the column, returns its name.
std::string axis_title(std::string_view column);

// Returns false if a mean of the column over the seeds of a sweep has no meaning. `column` is the name of a metric.
bool has_mean(std::string_view column);

}  // namespace stopline
