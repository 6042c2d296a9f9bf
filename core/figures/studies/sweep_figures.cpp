#include "figures/studies/sweep_figures.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "figures/studies/lines.h"
#include "figures/studies/planes.h"
#include "figures/studies/stability.h"
#include "figures/studies/surfaces.h"

namespace stopline {

namespace {

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

// Returns advice if the results have a column `name` without a unit, such as "green" instead of "green_s". The figures
// do not recognise such a column. A sweep writes such a column if each value of an axis sets several fields, and two
// axis values agree in the first field, as in "15 s / 5 s" and "15 s / 7 s". The column then holds all fields of an
// axis value as text.
std::string advice_for(const CsvTable& results, const std::vector<std::string>& axes, const std::string& name) {
    if (!contains(axes, name)) return "";
    return fmt::format(
        "; column '{0}' combines several fields ('{1}'), because the first field does not distinguish all values: give each field "
        "an axis of its own, or put a field first that differs in every value",
        name, results.rows.front()[results.column(name)]);
}

}  // namespace

bool is_network_sweep(const CsvTable& results) {
    return has_network_metrics(results, "population") && contains(results.columns, kGreenColumn) &&
           contains(results.columns, kOffsetColumn);
}

std::vector<Figure> sweep_figures(const CsvTable& results, const CellTitles& titles,
                                  const std::string& population_column, const std::string& baseline) {
    if (sweep_metrics(results, population_column).empty()) return {};
    const std::optional<SweepPlanes> all = sweep_planes(results, titles, population_column, baseline);
    if (!all) return {};
    std::vector<Figure> figures;
    for (std::size_t k = 0; k < all->planes.size(); ++k) {
        figures.push_back(sweep_lines_figure(*all, all->planes[k], k + 1));
        if (all->line_axis.exists()) figures.push_back(sweep_surfaces_figure(*all, all->planes[k], k + 1));
        if (all->has_stability && all->x_axis.has_numbers())
            figures.push_back(sweep_stability_figure(*all, all->planes[k], k + 1));
    }
    return figures;
}

std::string sweep_figures_note(const CsvTable& results, const CellTitles& titles,
                               const std::string& population_column) {
    if (sweep_metrics(results, population_column).empty()) return "";
    if (!has_network_metrics(results, population_column)) {
        if (sweep_planes(results, titles, population_column, "")) return "";
        return fmt::format("No figures: the sweep varies no axis with numbers, or they would be more than {}",
                           kMaxPlanes);
    }
    const std::vector<std::string> axes = axis_columns(results, population_column);
    if (contains(axes, kGreenColumn) && contains(axes, kOffsetColumn)) return "";
    const std::optional<SweepPlanes> all = sweep_planes(results, titles, population_column, "");
    std::string instead;
    if (all) {
        instead = "; the figures use " + all->x_axis.column +
                  (all->line_axis.exists() ? " and " + all->line_axis.column : "") +
                  (all->planes.size() > 1 ? " instead, for each combination of the other axes" : " instead");
    } else if (axes.size() > 2) {
        instead = fmt::format(
            "; there are no figures over the first two numeric axes either, because they would be more than {}",
            kMaxPlanes);
    }
    return fmt::format("No figures over green and offset: they need the columns {} and {} (columns found: {}){}{}{}",
                       kGreenColumn, kOffsetColumn, axes.empty() ? "none" : fmt::format("{}", fmt::join(axes, ", ")),
                       instead, advice_for(results, axes, "green"), advice_for(results, axes, "offset"));
}

}  // namespace stopline
