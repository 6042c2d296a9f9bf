#include "experiment/network_sweep_figures.h"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "experiment/network_sweep_lines.h"
#include "experiment/network_sweep_planes.h"
#include "experiment/network_sweep_stability.h"
#include "experiment/network_sweep_surfaces.h"

namespace stopline {

namespace {

bool has(const std::vector<std::string>& all, const std::string& name) {
    return std::find(all.begin(), all.end(), name) != all.end();
}

// Of an axis that is there but has no unit in its column, since it sets several fields.
std::string advice_for(const CsvTable& results, const std::vector<std::string>& axes, const std::string& name) {
    if (!has(axes, name)) return "";
    return fmt::format(
        "; the column '{0}' holds all fields that its axis sets ('{1}'), as the first one does not tell its values apart: give each "
        "field an axis of its own, or put first one that does",
        name, results.rows.front()[results.column(name)]);
}

}  // namespace

bool is_network_sweep(const CsvTable& results) {
    return has_network_metrics(results, "population") && has(results.columns, kGreenColumn) &&
           has(results.columns, kOffsetColumn);
}

std::vector<Figure> network_sweep_figures(const CsvTable& results, const CellTitles& titles,
                                          const std::string& population_column) {
    if (!has_network_metrics(results, population_column)) return {};
    const std::optional<SweepPlanes> all = sweep_planes(results, titles, population_column);
    if (!all) return {};
    std::vector<Figure> figures;
    for (std::size_t k = 0; k < all->planes.size(); ++k) {
        figures.push_back(sweep_lines_figure(*all, all->planes[k], k + 1));
        if (all->lines.there()) figures.push_back(sweep_surfaces_figure(*all, all->planes[k], k + 1));
        figures.push_back(sweep_stability_figure(*all, all->planes[k], k + 1));
    }
    return figures;
}

std::string network_sweep_note(const CsvTable& results, const CellTitles& titles,
                               const std::string& population_column) {
    if (!has_network_metrics(results, population_column)) return "";
    const std::vector<std::string> axes = axis_columns(results, population_column);
    if (has(axes, kGreenColumn) && has(axes, kOffsetColumn)) return "";
    const std::optional<SweepPlanes> all = sweep_planes(results, titles, population_column);
    std::string instead;
    if (all) {
        instead = "; drawn over " + all->across.column + (all->lines.there() ? " and " + all->lines.column : "") +
                  (all->planes.size() > 1 ? ", for each combination of the others" : "");
    } else if (axes.size() > 2) {
        instead = fmt::format("; over the first two axes of numbers they would be more than {}", kMostPlanes);
    }
    return fmt::format("No figures over green and offset: they need axes whose columns are {} and {} (here: {}){}{}{}",
                       kGreenColumn, kOffsetColumn, axes.empty() ? "none" : fmt::format("{}", fmt::join(axes, ", ")),
                       instead, advice_for(results, axes, "green"), advice_for(results, axes, "offset"));
}

}  // namespace stopline
