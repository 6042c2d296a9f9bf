#include "figures/studies/planes.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "base/io/csv.h"
#include "measure/confidence.h"
#include "runs/network/network_run.h"
#include "scenario/kinds/network_kind.h"

namespace stopline {

namespace {

constexpr double kPercent = 100.0;
constexpr std::size_t kSeedsForInterval = 3;  // the interval of two seeds is so wide that it tells nothing

template <class T>
std::size_t index_of(const std::vector<T>& all, const T& one) {
    return static_cast<std::size_t>(std::find(all.begin(), all.end(), one) - all.begin());
}

template <class T>
void add_new(std::vector<T>& all, const T& one) {
    if (index_of(all, one) == all.size()) all.push_back(one);
}

bool has_column(const CsvTable& table, const std::string& name) {
    return index_of(table.columns, name) < table.columns.size();
}

// Splits the name of a column into name and unit: "green_s" is green in s. This function is used for a table of results
// that is read without the settings of its sweep.
std::pair<std::string, std::string> name_and_unit(const std::string& column) {
    const std::size_t cut = column.rfind('_');
    if (cut == std::string::npos) return {column, ""};
    const std::string unit = column.substr(cut + 1);
    return {column.substr(0, cut), unit == "percent" ? "%" : unit};
}

// Returns the value of an axis as text for titles, such as "green 15 s".
std::string cell_title(const CellTitles& titles, const std::string& column, const std::string& cell) {
    const auto found = titles.find({column, cell});
    if (found != titles.end()) return found->second;
    const auto [name, unit] = name_and_unit(column);
    return name + " " + cell + (unit.empty() ? "" : " ") + unit;
}

// Sets name and unit of an axis from the title of one of its values: "green 15 s" or, for an axis that sets two fields,
// "green 15 s / 7 s".
void name_axis(PlotAxis& axis, const std::string& title, const std::string& cell) {
    const std::size_t end = title.find(" " + cell);
    axis.name = title.substr(0, end);
    const std::string rest = end == std::string::npos ? "" : title.substr(end + 1 + cell.size());
    if (rest.starts_with(" ") && !rest.starts_with(" / ")) axis.unit = rest.substr(1, rest.find(" / ") - 1);
}

// Returns the axis in a column, or nothing if a cell of the column is not a number.
std::optional<PlotAxis> numeric_axis(const CsvTable& results, const std::string& column, const CellTitles& titles) {
    std::map<double, std::string> cells;
    for (const std::vector<std::string>& row : results.rows) {
        const std::string& cell = row[results.column(column)];
        const std::optional<double> number = parse_number(cell);
        if (!number) return std::nullopt;
        cells.try_emplace(*number, cell);
    }
    PlotAxis axis;
    axis.column = column;
    axis.values.clear();
    for (const auto& [number, cell] : cells) {
        axis.values.push_back(number);
        axis.value_titles.push_back(cell_title(titles, column, cell));
    }
    name_axis(axis, axis.value_titles.front(), cells.begin()->second);
    return axis;
}

// Returns the axis in a column with the texts of its cells as values, in the order of the results.
PlotAxis text_axis(const CsvTable& results, const std::string& column, const CellTitles& titles) {
    PlotAxis axis;
    axis.column = column;
    axis.values.clear();
    for (const std::vector<std::string>& row : results.rows) add_new(axis.texts, row[results.column(column)]);
    for (const std::string& text : axis.texts) {
        axis.values.push_back(static_cast<double>(axis.values.size()));
        axis.value_titles.push_back(cell_title(titles, column, text));
    }
    name_axis(axis, axis.value_titles.front(), axis.texts.front());
    return axis;
}

// Returns the x axis and the line axis of the figures, in this order. Returns the x axis alone if a single axis varies.
// If no numeric axis varies, returns the axis `green` if the table has the axes `green` and `offset`, otherwise the
// last axis of texts that varies. Returns nothing if no axis varies.
std::vector<PlotAxis> drawn_axes(const CsvTable& results, const CellTitles& titles,
                                 const std::string& population_column) {
    std::vector<PlotAxis> all;
    std::vector<PlotAxis> last_texts;  // at most one
    for (const std::string& column : axis_columns(results, population_column)) {
        if (std::optional<PlotAxis> axis = numeric_axis(results, column, titles)) {
            all.push_back(std::move(*axis));
        } else if (PlotAxis texts = text_axis(results, column, titles); texts.values.size() > 1) {
            last_texts = {std::move(texts)};
        }
    }
    const auto single = [](const PlotAxis& axis) { return axis.values.size() == 1; };
    std::vector<PlotAxis> paper;
    for (const char* const column : {kGreenColumn, kOffsetColumn}) {
        for (const PlotAxis& axis : all) {
            if (axis.column == column) paper.push_back(axis);
        }
    }
    std::vector<PlotAxis> varied = paper.size() == 2 && !std::all_of(paper.begin(), paper.end(), single) ? paper : all;
    std::erase_if(varied, single);
    if (varied.empty()) return paper.size() == 2 ? std::vector<PlotAxis>{paper.front()} : last_texts;
    if (varied.size() > 2) varied.resize(2);  // each combination of the other axes gets figures of its own
    // As in the paper, the axis `green` is the x axis and the axis `offset` is the line axis.
    if (varied.size() == 2 && (varied[0].column == kOffsetColumn || varied[1].column == kGreenColumn)) {
        std::swap(varied[0], varied[1]);
    }
    return varied;
}

bool has_paper_axes(const SweepPlanes& all) {
    return all.x_axis.column == kGreenColumn && all.line_axis.column == kOffsetColumn;
}

// Returns the number of planes: combinations of values of the axes that are neither x axis nor line axis.
std::size_t plane_count(const CsvTable& results, const SweepPlanes& all, const std::string& population_column) {
    std::set<std::vector<std::string>> combinations;
    for (const std::vector<std::string>& row : results.rows) {
        std::vector<std::string> cells;
        for (const std::string& column : axis_columns(results, population_column)) {
            if (column != all.x_axis.column && column != all.line_axis.column)
                cells.push_back(row[results.column(column)]);
        }
        combinations.insert(cells);
    }
    return combinations.size();
}

std::string title_of(const CsvTable& results, const std::vector<std::string>& row, const SweepPlanes& planes,
                     const CellTitles& titles, const std::string& population_column) {
    std::string text;
    for (const std::string& column : axis_columns(results, population_column)) {
        if (column == planes.x_axis.column || column == planes.line_axis.column) continue;
        text += (text.empty() ? "" : "; ") + cell_title(titles, column, row[results.column(column)]);
    }
    return text;
}

std::size_t index_on(const PlotAxis& axis, const CsvTable& results, const std::vector<std::string>& row) {
    if (!axis.exists()) return 0;
    if (!axis.has_numbers()) return index_of(axis.texts, row[results.column(axis.column)]);
    return index_of(axis.values, parse_number(row[results.column(axis.column)]).value_or(0.0));
}

void add_row(SweepPlane& plane, const PlanePoint& point, const SweepPlanes& all, const CsvTable& results,
             const std::vector<std::string>& row) {
    for (std::size_t metric = 0; metric < all.metrics.size(); ++metric) {
        const std::optional<double> value = parse_number(row[results.column(all.metrics[metric].column)]);
        if (value) plane.add(metric, point, row[results.column("seed")], *value);
    }
    if (!all.has_stability) return;
    const auto known = std::find(kStabilityNames.begin(), kStabilityNames.end(), row[results.column("stability")]);
    if (known != kStabilityNames.end()) {
        plane.add_stability(point, static_cast<std::size_t>(known - kStabilityNames.begin()));
    }
}

SeedSpread spread_of(const std::vector<double>& values) {
    const double mean = mean_of(values);
    if (values.size() < kSeedsForInterval) return {mean, mean, mean};
    const Interval interval = confidence_interval(values, Band::student);
    return {mean, interval.low, interval.high};
}

// Returns the name of the last column of the table that belongs to the metric, or "" if there is none.
std::string column_of(const CsvTable& results, const DrawnMetric& metric) {
    const auto found = std::find_if(results.columns.rbegin(), results.columns.rend(),
                                    [&](const std::string& column) { return metric.has(column); });
    return found == results.columns.rend() ? "" : *found;
}

// Returns the metrics of a group that the figures of sweeps show. Returns nothing if the table lacks one that all
// scenarios have.
std::vector<SweepMetric> metrics_of(const MetricGroup& group, const CsvTable& results) {
    std::vector<SweepMetric> metrics;
    // Only tables of networks have the column `stability`. Without it, the table belongs to another group.
    if (group.name == kRunAsNetwork && !has_column(results, "stability")) return {};
    for (const DrawnMetric& metric : group.drawn) {
        const SweepPanels& panels = metric.figure.sweep;
        if (!panels.exist()) continue;
        const std::string column = column_of(results, metric);
        if (column.empty() && metric.is_optional) continue;
        if (column.empty()) return {};
        const std::string name = panels.name.empty() ? metric.axis(column) : std::string(panels.name);
        metrics.push_back({column, name, std::string(metric.unit), std::string(panels.change), panels.better});
    }
    return metrics;
}

bool has_runs(const CsvTable& results, const std::string& population_column) {
    return !results.rows.empty() && has_column(results, population_column) && has_column(results, "seed");
}

}  // namespace

std::vector<SweepMetric> sweep_metrics(const CsvTable& results, const std::string& population_column,
                                       const std::vector<MetricGroup>& groups) {
    if (!has_runs(results, population_column)) return {};
    for (const MetricGroup& group : groups) {
        const std::vector<SweepMetric> metrics = metrics_of(group, results);
        if (!metrics.empty()) return metrics;
    }
    return {};
}

bool SweepPlane::has(std::size_t metric) const {
    return std::any_of(values_.begin(), values_.end(), [&](const auto& entry) { return entry.first.first == metric; });
}

const SweepPlane::Seeds* SweepPlane::seeds(std::size_t metric, const PlanePoint& point) const {
    const auto found = values_.find({metric, point});
    return found == values_.end() ? nullptr : &found->second;
}

std::optional<SeedSpread> SweepPlane::value(std::size_t metric, const PlanePoint& point) const {
    const Seeds* const here = seeds(metric, point);
    if (here == nullptr) return std::nullopt;
    std::vector<double> values;
    for (const auto& [seed, value] : *here) values.push_back(value);
    return spread_of(values);
}

std::optional<SeedSpread> SweepPlane::change(std::size_t metric, const PlanePoint& point, double sign) const {
    const Seeds* const runs_here = seeds(metric, point);
    const Seeds* const runs_of_base = seeds(metric, {point.x, point.line, 0});
    if (runs_here == nullptr || runs_of_base == nullptr) return std::nullopt;
    std::vector<double> differences;
    double sum_of_base = 0.0;
    for (const auto& [seed, here] : *runs_here) {
        const auto before = runs_of_base->find(seed);
        if (before == runs_of_base->end()) continue;
        differences.push_back(here - before->second);
        sum_of_base += before->second;
    }
    if (differences.empty() || sum_of_base == 0.0) return std::nullopt;
    const double percent = sign * kPercent * static_cast<double>(differences.size()) / sum_of_base;
    const SeedSpread spread = spread_of(differences);
    const auto [low, high] = std::minmax({percent * spread.low, percent * spread.high});
    return SeedSpread{percent * spread.mean, low, high};
}

std::array<std::size_t, 3> SweepPlane::stabilities(const PlanePoint& point) const {
    std::array<std::size_t, kStabilityNames.size()> counts{};
    const auto found = stability_.find(point);
    if (found == stability_.end()) return counts;
    for (const std::size_t stability : found->second) ++counts[stability];
    return counts;
}

std::string SweepPlanes::title(const SweepPlane& plane, const std::string& seed_note) const {
    if (seeds < 2) return plane.title;
    if (seeds < kSeedsForInterval) {
        return plane.title + (plane.title.empty() ? "" : "; ") + fmt::format("means of {} seeds", seeds);
    }
    return plane.title + (plane.title.empty() ? "" : "; ") + fmt::format(fmt::runtime(seed_note), seeds);
}

std::string SweepPlanes::change_label(const SweepMetric& metric) const {
    return fmt::format(fmt::runtime(metric.change), populations.front());
}

bool has_network_metrics(const CsvTable& results, const std::string& population_column) {
    return has_runs(results, population_column) && !metrics_of(metric_group(kRunAsNetwork), results).empty();
}

std::vector<std::string> axis_columns(const CsvTable& results, const std::string& population_column) {
    std::vector<std::string> columns;
    for (const std::string& column : results.columns) {
        if (column == "seed") break;
        if (column != "point" && column != population_column) columns.push_back(column);
    }
    return columns;
}

std::optional<SweepPlanes> sweep_planes(const CsvTable& results, const CellTitles& titles,
                                        const std::string& population_column, const std::string& baseline,
                                        const std::vector<MetricGroup>& groups) {
    const std::vector<PlotAxis> axes = drawn_axes(results, titles, population_column);
    if (axes.empty()) return std::nullopt;
    SweepPlanes all;
    all.metrics = sweep_metrics(results, population_column, groups);
    all.has_stability = has_column(results, "stability");
    const auto has_baseline = [&](const auto& row) { return row[results.column(population_column)] == baseline; };
    for (const std::vector<std::string>& row : results.rows) {
        add_new(all.names_in_order, row[results.column(population_column)]);
    }
    if (std::any_of(results.rows.begin(), results.rows.end(), has_baseline)) all.populations.push_back(baseline);
    all.x_axis = axes.front();
    if (axes.size() == 2) all.line_axis = axes.back();
    if (plane_count(results, all, population_column) > kMaxPlanes && !has_paper_axes(all)) return std::nullopt;
    std::vector<std::string> seeds;
    for (const std::vector<std::string>& row : results.rows) {
        const std::string& population = row[results.column(population_column)];
        add_new(all.populations, population);
        add_new(seeds, row[results.column("seed")]);
        const std::string title = title_of(results, row, all, titles, population_column);
        auto plane =
            std::find_if(all.planes.begin(), all.planes.end(), [&](const SweepPlane& p) { return p.title == title; });
        if (plane == all.planes.end()) {
            plane = all.planes.emplace(all.planes.end());
            plane->title = title;
        }
        add_row(*plane,
                {index_on(all.x_axis, results, row), index_on(all.line_axis, results, row),
                 index_of(all.populations, population)},
                all, results, row);
    }
    all.seeds = seeds.size();
    return all;
}

}  // namespace stopline
