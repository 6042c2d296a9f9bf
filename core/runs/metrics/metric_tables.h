// Writes the metrics of runs as tables. `metrics` is a list such as network_metrics(), and `runs` are the runs of all
// populations of one scenario.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "base/io/csv.h"
#include "runs/metrics/metric.h"
#include "runs/metrics/metric_groups.h"
#include "runs/metrics/metric_text.h"
#include "runs/run_metrics.h"
#include "runs/tables/column_docs.h"

namespace stopline {

// A column that an entry gives.
template <class Run>
struct MetricColumn {
    const Metric<Run>* metric = nullptr;
    std::size_t key = 0;        // index of the key in the family of the metric
    std::string key_name = {};  // empty: the metric has no family

    std::string name() const { return keyed(metric->column, key_name); }
    MetricValue value(const Run& run) const { return call(metric->value, run); }
    ColumnDoc doc() const {
        const std::string_view meaning = is_described() ? metric->family->described[key].meaning : metric->meaning;
        return {name(), std::string(metric->unit), std::string(metric->extent), keyed(meaning, key_name)};
    }
    // Returns the heading on the console. A long key, such as "wrong_lane", takes several lines.
    std::string console_heading() const { return keyed(metric->console.heading, with_key(key_name, "_", "\n")); }
    std::string console_unit() const {
        return std::string(metric->console.unit.empty() ? metric->unit : metric->console.unit);
    }
    std::string console_note() const {
        const std::string_view note = is_described() ? metric->family->described[key].console_note : "";
        return keyed(note.empty() ? metric->console.note : note, key_name);
    }
    std::string console_cell(const Run& run) const {
        const ConsoleColumn<Run>& console = metric->console;
        return call(console.value ? console.value : metric->value, run)
            .console_cell(console.decimals, console.has_sign);
    }

private:
    bool is_described() const { return metric->family != nullptr && !metric->family->described.empty(); }
    std::string keyed(std::string_view text, std::string_view name_of_key) const {
        return metric->family == nullptr ? std::string(text) : with_key(text, metric->family->placeholder, name_of_key);
    }
    MetricValue call(const std::function<MetricValue(const Run&)>& function, const Run& run) const {
        Run run_with_key(run);
        run_with_key.key = key;
        return function(run_with_key);
    }
};

template <class Run>
using MetricColumns = std::vector<MetricColumn<Run>>;

// Returns the columns of the entries for which `is_wanted` returns true, in the order of the list. A null `scenario`
// gives the columns for the documentation of all scenarios.
template <class Run, class IsWanted>
MetricColumns<Run> metric_columns(const MetricList<Run>& metrics, const Scenario* scenario, const IsWanted& is_wanted) {
    std::vector<const Metric<Run>*> wanted;
    for (const Metric<Run>& metric : metrics) {
        const bool applies =
            scenario == nullptr || metric.only_for == nullptr || network_kind(scenario->network).*metric.only_for;
        const bool is_asked_for = scenario == nullptr || metric.asked_for == nullptr || metric.asked_for(*scenario);
        if (applies && is_asked_for && is_wanted(metric)) wanted.push_back(&metric);
    }
    MetricColumns<Run> columns;
    for (std::size_t first = 0; first < wanted.size();) {
        const MetricFamily* const family = wanted[first]->family;
        if (family == nullptr) {
            columns.push_back({wanted[first++]});
            continue;
        }
        std::size_t end = first;
        while (end < wanted.size() && wanted[end]->family == family) ++end;
        const std::vector<std::string> keys = family->key_names(scenario);
        for (std::size_t key = 0; key < keys.size(); ++key) {
            for (std::size_t k = first; k < end; ++k) columns.push_back({wanted[k], key, keys[key]});
        }
        first = end;
    }
    return columns;
}

// Returns the columns of summary.csv after `population`.
template <class Run>
MetricColumns<Run> summary_columns(const MetricList<Run>& metrics, const Scenario* scenario) {
    return metric_columns(metrics, scenario, [](const Metric<Run>& metric) { return metric.in_summary(); });
}

// Returns the columns of a table of a sweep after the axes and the seed.
template <class Run>
MetricColumns<Run> sweep_columns(const MetricList<Run>& metrics, const Scenario* scenario) {
    MetricColumns<Run> columns;
    MetricColumns<Run> moved;
    for (MetricColumn<Run>& column :
         metric_columns(metrics, scenario, [](const Metric<Run>& metric) { return metric.in_sweeps(); })) {
        (column.metric->sweep_after.empty() ? columns : moved).push_back(std::move(column));
    }
    for (MetricColumn<Run>& column : moved) {
        const auto before = std::find_if(columns.begin(), columns.end(), [&](const MetricColumn<Run>& other) {
            return other.metric->column == column.metric->sweep_after;
        });
        columns.insert(before == columns.end() ? before : before + 1, std::move(column));
    }
    return columns;
}

// Returns the text of summary.csv, with one row for each run.
template <class Run>
std::string metrics_csv(const MetricList<Run>& metrics, const Scenario& scenario, const std::vector<Run>& runs) {
    const MetricColumns<Run> columns = summary_columns(metrics, &scenario);
    std::vector<std::string> row{"population"};
    for (const MetricColumn<Run>& column : columns) row.push_back(column.name());
    CsvWriter csv(row);
    for (const Run& run : runs) {
        row = {run.population()};
        for (const MetricColumn<Run>& column : columns) {
            row.push_back(column.value(run).csv_cell(column.metric->summary_decimals));
        }
        csv.row(row);
    }
    return csv.text();
}

// Returns the metrics of a run for the table of a sweep.
template <class Run>
std::vector<RunMetric> sweep_metrics(const MetricList<Run>& metrics, const Run& run) {
    std::vector<RunMetric> row;
    for (const MetricColumn<Run>& column : sweep_columns(metrics, &run.scenario)) {
        row.push_back({column.name(), column.value(run).csv_cell(column.metric->sweep_decimals)});
    }
    return row;
}

// Returns the names of the columns of sweep_metrics().
template <class Run>
std::vector<std::string> sweep_column_names(const MetricList<Run>& metrics, const Scenario& scenario) {
    std::vector<std::string> names;
    for (const MetricColumn<Run>& column : sweep_columns(metrics, &scenario)) names.push_back(column.name());
    return names;
}

template <class Run>
MetricColumns<Run> console_columns(const MetricList<Run>& metrics, const Scenario& scenario, ConsoleTable table) {
    return metric_columns(metrics, &scenario, [&](const Metric<Run>& metric) {
        const bool is_asked_for = metric.console.asked_for == nullptr || metric.console.asked_for(scenario);
        return metric.console.is_in(table) && is_asked_for;
    });
}

// Returns the rows of a console table: headings, units, and one row for each run.
template <class Run>
std::vector<std::vector<std::string>> console_rows(const MetricList<Run>& metrics, const Scenario& scenario,
                                                   const std::vector<Run>& runs,
                                                   ConsoleTable table = ConsoleTable::results) {
    ConsoleHead head;
    std::vector<std::vector<std::string>> cells;
    for (const Run& run : runs) cells.push_back({run.population()});
    for (const MetricColumn<Run>& column : console_columns(metrics, scenario, table)) {
        if (column.metric->console.begins_part && column.key == 0) {
            head.add_bar();
            for (std::vector<std::string>& row : cells) row.emplace_back("|");
        }
        head.add(column.console_heading(), column.console_unit());
        for (std::size_t k = 0; k < runs.size(); ++k) cells[k].push_back(column.console_cell(runs[k]));
    }
    std::vector<std::vector<std::string>> rows = head.rows();
    rows.insert(rows.end(), cells.begin(), cells.end());
    return rows;
}

// Returns the explanations of the columns of a console table, such as "queue: stopped vehicles per lane".
template <class Run>
std::vector<std::string> console_notes(const MetricList<Run>& metrics, const Scenario& scenario,
                                       ConsoleTable table = ConsoleTable::results) {
    std::vector<std::string> notes;
    for (const MetricColumn<Run>& column : console_columns(metrics, scenario, table)) {
        const std::string note = column.console_note();
        if (!note.empty()) notes.push_back(with_key(column.console_heading(), "\n", " ") + ": " + note);
    }
    return notes;
}

// Returns the descriptions of columns, for COLUMNS.md.
template <class Run>
std::vector<ColumnDoc> metric_docs(const MetricColumns<Run>& columns) {
    std::vector<ColumnDoc> docs;
    for (const MetricColumn<Run>& column : columns) docs.push_back(column.doc());
    return docs;
}

// Returns all metrics in CSV tables, for figures.
template <class Run>
std::vector<DrawnMetric> drawn_metrics(const MetricList<Run>& metrics) {
    std::vector<DrawnMetric> drawn;
    for (const Metric<Run>& metric : metrics) {
        if (!metric.in_summary() && !metric.in_sweeps()) continue;
        drawn.push_back({metric.column, metric.family == nullptr ? "" : metric.family->placeholder, metric.unit,
                         metric.figure, metric.asked_for != nullptr});
    }
    return drawn;
}

// Returns all metrics in CSV tables, for stopline-run --list. A null `scenario` gives those of all scenarios.
template <class Run>
std::vector<ListedMetric> listed_metrics(const MetricList<Run>& metrics, const Scenario* scenario) {
    std::vector<ListedMetric> listed;
    const auto is_listed = [](const Metric<Run>& metric) { return metric.in_summary() || metric.in_sweeps(); };
    for (const MetricColumn<Run>& column : metric_columns(metrics, scenario, is_listed)) {
        const ColumnDoc doc = column.doc();
        const char* const table = !column.metric->in_sweeps()    ? " (summary.csv only)"
                                  : !column.metric->in_summary() ? " (sweeps only)"
                                                                 : "";
        listed.push_back({doc.name, doc.unit, first_statement(doc.meaning) + table});
    }
    return listed;
}

}  // namespace stopline
