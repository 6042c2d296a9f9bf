#include "experiment/network_sweep_planes.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "experiment/network_run.h"
#include "experiment/targets.h"

namespace stopline {

namespace {

constexpr double kPercent = 100.0;

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

// Of a table that is read without its sweep: "green_s" is green in s.
std::pair<std::string, std::string> name_and_unit(const std::string& column) {
    const std::size_t cut = column.rfind('_');
    if (cut == std::string::npos) return {column, ""};
    const std::string unit = column.substr(cut + 1);
    return {column.substr(0, cut), unit == "percent" ? "%" : unit};
}

std::string words_of(const CellTitles& titles, const std::string& column, const std::string& cell) {
    const auto found = titles.find({column, cell});
    if (found != titles.end()) return found->second;
    const auto [name, unit] = name_and_unit(column);
    return name + " " + cell + (unit.empty() ? "" : " ") + unit;
}

// Name and unit from what stands for a cell in titles: "green 15 s" or, of fields set together, "green 15 s / 7 s".
void name_axis(DrawnAxis& axis, const std::string& words, const std::string& cell) {
    const std::size_t end = words.find(" " + cell);
    axis.name = words.substr(0, end);
    const std::string rest = end == std::string::npos ? "" : words.substr(end + 1 + cell.size());
    if (rest.starts_with(" ") && !rest.starts_with(" / ")) axis.unit = rest.substr(1, rest.find(" / ") - 1);
}

// Nothing where a cell is not a number.
std::optional<DrawnAxis> axis_of_numbers(const CsvTable& results, const std::string& column, const CellTitles& titles) {
    std::map<double, std::string> cells;
    for (const std::vector<std::string>& row : results.rows) {
        const std::string& cell = row[results.column(column)];
        const std::optional<double> number = parse_number(cell);
        if (!number) return std::nullopt;
        cells.try_emplace(*number, cell);
    }
    DrawnAxis axis;
    axis.column = column;
    axis.values.clear();
    for (const auto& [number, cell] : cells) {
        axis.values.push_back(number);
        axis.words.push_back(words_of(titles, column, cell));
    }
    name_axis(axis, axis.words.front(), cells.begin()->second);
    return axis;
}

// One or two axes, the one across first; none where it is not clear which.
std::vector<DrawnAxis> drawn_axes(const CsvTable& results, const CellTitles& titles,
                                  const std::string& population_column) {
    std::vector<DrawnAxis> all;
    for (const std::string& column : axis_columns(results, population_column)) {
        if (std::optional<DrawnAxis> axis = axis_of_numbers(results, column, titles)) all.push_back(std::move(*axis));
    }
    const auto single = [](const DrawnAxis& axis) { return axis.values.size() == 1; };
    std::vector<DrawnAxis> paper;
    for (const char* const column : {kGreenColumn, kOffsetColumn}) {
        for (const DrawnAxis& axis : all) {
            if (axis.column == column) paper.push_back(axis);
        }
    }
    std::vector<DrawnAxis> varied = paper.size() == 2 && !std::all_of(paper.begin(), paper.end(), single) ? paper : all;
    std::erase_if(varied, single);
    if (varied.empty() && paper.size() == 2) return {paper.front()};
    if (varied.size() > 2) varied.resize(2);  // for each value of the others a figure
    // As in the paper: over green, a line an offset.
    if (varied.size() == 2 && (varied[0].column == kOffsetColumn || varied[1].column == kGreenColumn)) {
        std::swap(varied[0], varied[1]);
    }
    return varied;
}

bool is_of_paper(const SweepPlanes& all) {
    return all.across.column == kGreenColumn && all.lines.column == kOffsetColumn;
}

// How many combinations of the axes there are that are not drawn over.
std::size_t planes_of(const CsvTable& results, const SweepPlanes& all, const std::string& population_column) {
    std::set<std::vector<std::string>> combinations;
    for (const std::vector<std::string>& row : results.rows) {
        std::vector<std::string> cells;
        for (const std::string& column : axis_columns(results, population_column)) {
            if (column != all.across.column && column != all.lines.column) cells.push_back(row[results.column(column)]);
        }
        combinations.insert(cells);
    }
    return combinations.size();
}

std::string title_of(const CsvTable& results, const std::vector<std::string>& row, const SweepPlanes& planes,
                     const CellTitles& titles, const std::string& population_column) {
    std::string text;
    for (const std::string& column : axis_columns(results, population_column)) {
        if (column == planes.across.column || column == planes.lines.column) continue;
        text += (text.empty() ? "" : "; ") + words_of(titles, column, row[results.column(column)]);
    }
    return text;
}

std::size_t index_on(const DrawnAxis& axis, const CsvTable& results, const std::vector<std::string>& row) {
    if (!axis.there()) return 0;
    return index_of(axis.values, parse_number(row[results.column(axis.column)]).value_or(0.0));
}

void add_row(SweepPlane& plane, const SweepPlace& place, const CsvTable& results, const std::vector<std::string>& row) {
    for (std::size_t metric = 0; metric < kSweepMetrics.size(); ++metric) {
        const std::optional<double> value = parse_number(row[results.column(kSweepMetrics[metric].column)]);
        if (value) plane.add(metric, place, row[results.column("seed")], *value);
    }
    const auto known = std::find(kStabilityNames.begin(), kStabilityNames.end(), row[results.column("stability")]);
    if (known != kStabilityNames.end()) {
        plane.add_stability(place, static_cast<std::size_t>(known - kStabilityNames.begin()));
    }
}

}  // namespace

bool SweepPlane::has(std::size_t metric) const {
    return std::any_of(values_.begin(), values_.end(), [&](const auto& one) { return one.first.first == metric; });
}

const SweepPlane::Seeds* SweepPlane::seeds(std::size_t metric, const SweepPlace& place) const {
    const auto found = values_.find({metric, place});
    return found == values_.end() ? nullptr : &found->second;
}

std::optional<SeedSpread> SweepPlane::value(std::size_t metric, const SweepPlace& place) const {
    const Seeds* const here = seeds(metric, place);
    if (here == nullptr) return std::nullopt;
    SeedSpread spread{0.0, here->begin()->second, here->begin()->second};
    for (const auto& [seed, value] : *here) {
        spread.mean += value / static_cast<double>(here->size());
        spread.least = std::min(spread.least, value);
        spread.greatest = std::max(spread.greatest, value);
    }
    return spread;
}

std::optional<SeedSpread> SweepPlane::change(std::size_t metric, const SweepPlace& place) const {
    const SweepPlace base{place.across, place.line, 0};
    const std::optional<SeedSpread> mean_here = value(metric, place);
    const std::optional<SeedSpread> mean_base = value(metric, base);
    if (!mean_here || !mean_base || mean_base->mean == 0.0) return std::nullopt;
    const double sign = kSweepMetrics[metric].sign;
    const double of_means = sign * kPercent * (mean_here->mean / mean_base->mean - 1.0);
    SeedSpread spread{of_means, of_means, of_means};
    const Seeds& runs_of_base = *seeds(metric, base);
    for (const auto& [seed, here] : *seeds(metric, place)) {
        const auto before = runs_of_base.find(seed);
        if (before == runs_of_base.end() || before->second == 0.0) continue;
        const double change = sign * kPercent * (here / before->second - 1.0);
        spread.least = std::min(spread.least, change);
        spread.greatest = std::max(spread.greatest, change);
    }
    return spread;
}

std::array<std::size_t, 3> SweepPlane::stabilities(const SweepPlace& place) const {
    std::array<std::size_t, kStabilityNames.size()> counts{};
    const auto found = stability_.find(place);
    if (found == stability_.end()) return counts;
    for (const std::size_t stability : found->second) ++counts[stability];
    return counts;
}

std::string SweepPlanes::title(const SweepPlane& plane, const std::string& of_seeds) const {
    if (seeds < 2) return plane.title;
    return plane.title + (plane.title.empty() ? "" : "; ") + fmt::format(fmt::runtime(of_seeds), seeds);
}

std::string SweepPlanes::change_label(const SweepMetric& metric) const {
    return fmt::format(fmt::runtime(metric.change), populations.front());
}

bool has_network_metrics(const CsvTable& results, const std::string& population_column) {
    const auto there = [&](const std::string& name) { return has_column(results, name); };
    return there(population_column) && there("seed") && there("stability") && !results.rows.empty() &&
           std::all_of(kSweepMetrics.begin(), kSweepMetrics.end(),
                       [&](const SweepMetric& m) { return there(m.column); });
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
                                        const std::string& population_column) {
    const std::vector<DrawnAxis> axes = drawn_axes(results, titles, population_column);
    if (axes.empty()) return std::nullopt;
    SweepPlanes all;
    all.across = axes.front();
    if (axes.size() == 2) all.lines = axes.back();
    if (planes_of(results, all, population_column) > kMostPlanes && !is_of_paper(all)) return std::nullopt;
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
                {index_on(all.across, results, row), index_on(all.lines, results, row),
                 index_of(all.populations, population)},
                results, row);
    }
    all.seeds = seeds.size();
    return all;
}

}  // namespace stopline
