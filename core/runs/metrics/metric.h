// The table of metrics. One entry describes a metric of a run and computes its value. These outputs read the entries:
// summary.csv, the table of a sweep, the console, the axes of figures, COLUMNS.md, stopline-run --list and the results
// page.
//
// Each way of running a scenario (runs/run_kind.h) has a list of entries: single_light_metrics.h,
// intersection_metrics.h and network_metrics.h. The order of a list is the order of the columns.
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scenario/kinds/network_kind.h"
#include "scenario/scenario.h"

namespace stopline {

// The value of a metric: a number, a count or a text. The constructors convert implicitly, so that the function of an
// entry returns its result as it is.
class MetricValue {
public:
    MetricValue(double number) : value_(number) {}  // NOLINT(google-explicit-constructor)
    template <std::integral Count>
    MetricValue(Count count) : value_(static_cast<std::int64_t>(count)) {}  // NOLINT(google-explicit-constructor)
    MetricValue(std::string text) : value_(std::move(text)) {}              // NOLINT(google-explicit-constructor)
    MetricValue(const char* text) : value_(std::string(text)) {}            // NOLINT(google-explicit-constructor)

    // Returns the value as a cell of a CSV table. `decimals` applies to numbers only. NaN gives an empty cell.
    std::string csv_cell(int decimals) const;
    // Returns the value as a cell of a console table. NaN gives "-". With `has_sign`, numbers above 0 have a sign too.
    std::string console_cell(int decimals, bool has_sign) const;

private:
    std::variant<double, std::int64_t, std::string> value_;
};

// A key of a family, such as a delay cause, with the meaning of its metric.
struct MetricKey {
    std::string_view name;
    std::string_view meaning;
    std::string_view console_note = {};  // explanation below a console table
};

// A family of metrics: one entry that gives a column for each key. If neighbouring entries have the same family, the
// columns of all these entries for the first key come first, then those for the second key.
struct MetricFamily {
    std::string_view placeholder;  // CAPITALS that stand for the key in the name of a column
    // Returns the names of the keys. Null: the keys are those in `described`.
    std::vector<std::string> (*keys)(const Scenario& scenario) = nullptr;
    // Keys that all scenarios have. The documentation has a row for each of them.
    std::span<const MetricKey> described = {};

    // Returns the names of the keys of a scenario. Without a scenario, returns those for the documentation: the keys in
    // `described`, or the placeholder.
    std::vector<std::string> key_names(const Scenario* scenario) const;
};

// The tables of metrics on the console. All kinds of networks have `results`. Networks of several intersections also
// have `congestion`, and imported networks also have `trips`.
enum class ConsoleTable : std::uint8_t { results, congestion, trips };

// Value of summary_decimals or sweep_decimals if the table does not have the metric.
inline constexpr int kLeftOut = -1;

// Appearance of a metric on the console.
template <class Run>
struct ConsoleColumn {
    ConsoleTable table = ConsoleTable::results;
    std::string_view heading = {};  // lines are separated by '\n'; empty: the metric is not on the console
    int decimals = 0;
    std::string_view note = {};  // explanation below the table; empty: none
    bool has_sign = false;       // true: numbers above 0 have a sign
    bool begins_part = false;    // true: a vertical bar precedes the column
    // A value for the console that differs from Metric::value, and its unit. Empty: those of the metric.
    std::function<MetricValue(const Run&)> value;
    std::string_view unit = {};
    // Returns true for scenarios whose console tables have the column. Null: all scenarios that have the metric.
    bool (*asked_for)(const Scenario& scenario) = nullptr;

    bool is_in(ConsoleTable wanted) const { return !heading.empty() && table == wanted; }
};

// Tells which value of a metric is better than that of the baseline: a higher one, a lower one, or neither.
enum class Better : std::uint8_t { higher, lower, neither };

// Panels of a metric in the figures of sweeps: its value, and its change against the baseline.
struct SweepPanels {
    // Title of the axis for the change. `{}` stands for the name of the baseline. Empty: the figures leave the metric
    // out. If `better` is `lower`, a fall of the metric is a positive change.
    std::string_view change = {};
    Better better = Better::higher;
    std::string_view name = {};  // name on the axis for the value; empty: MetricFigure::axis

    bool exist() const { return !change.empty(); }
};

// Appearance of a metric in figures.
struct MetricFigure {
    std::string_view axis = {};  // name on axes; empty: the name of the column without its unit
    // The figures of sweeps show only the last key of a family, such as the last green time.
    SweepPanels sweep = {};
};

// A metric of a run. `Run` is a type that refers to one finished run, such as MeasuredNetwork. It has the members
// `scenario`, `key` and population(). In a family, Run::key is the index of the key for which `value` is called.
template <class Run>
struct Metric {
    std::string_view column;       // name in CSV tables, which ends with the unit
    std::string_view unit = {};    // unit for readers, such as "veh/h"; empty: none
    std::string_view extent = {};  // part of the run that the value covers (ColumnDoc::extent)
    std::string_view meaning = {};
    std::function<MetricValue(const Run&)> value;
    int summary_decimals = 0;           // decimals of a number in summary.csv, or kLeftOut
    int sweep_decimals = 6;             // decimals of a number in tables of sweeps, or kLeftOut
    std::string_view sweep_after = {};  // column that precedes this one in sweeps; empty: the order of the list applies
    bool has_mean = true;               // false: a mean over the seeds of a sweep has no meaning
    const MetricFamily* family = nullptr;
    // Property of the kinds of networks that have the metric, such as &NetworkKind::has_trips. Null: each kind of the
    // list has the metric.
    bool NetworkKind::*only_for = nullptr;
    // Returns true for scenarios that ask for the metric. Null: all scenarios have it.
    bool (*asked_for)(const Scenario& scenario) = nullptr;
    ConsoleColumn<Run> console;
    MetricFigure figure = {};

    bool in_summary() const { return summary_decimals != kLeftOut; }
    bool in_sweeps() const { return sweep_decimals != kLeftOut; }
};

template <class Run>
using MetricList = std::vector<Metric<Run>>;

// Returns the lists one after the other.
template <class Run>
MetricList<Run> joined_lists(std::initializer_list<MetricList<Run>> lists) {
    MetricList<Run> all;
    for (const MetricList<Run>& list : lists) all.insert(all.end(), list.begin(), list.end());
    return all;
}

}  // namespace stopline
