#include "figures/studies/stability.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "figures/studies/cells.h"
#include "runs/network/network_run.h"

namespace stopline {

namespace {

struct StabilityMark {
    const char* colour;
    const char* fill;
    int point;  // gnuplot point type; a reader can distinguish the marks even without colours
};
constexpr std::array<StabilityMark, kStabilityNames.size()> kMarks{StabilityMark{"#009e73", "#cdeee3", 7},
                                                                   StabilityMark{"#e69f00", "#fbe9c3", 5},
                                                                   StabilityMark{"#d55e00", "#f5ccb2", 9}};

struct StabilityMap {
    std::string heading;
    std::string data;
};

// Returns the data of one cell: index on both axes, worst stability, and the share of seeds with this stability, such
// as 2/6.
std::string cell_of(const SweepPlane& plane, const PlanePoint& point, std::size_t y) {
    const auto counts = plane.stabilities(point);
    const std::size_t seeds = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
    if (seeds == 0) return "";
    std::size_t worst = counts.size() - 1;
    while (counts[worst] == 0) --worst;
    return fmt::format("{} {} {} {}/{}\n", point.x, y, worst, counts[worst], seeds);
}

// Returns one map for each population, with the values of the sweep's second axis (`line_axis`) as rows. If the sweep
// has no second axis, returns a single map with the populations as rows, the first population at the top.
std::vector<StabilityMap> maps_of(const SweepPlanes& all, const SweepPlane& plane) {
    const bool map_per_population = all.line_axis.exists();
    const std::size_t populations = all.populations.size();
    std::vector<StabilityMap> maps(map_per_population ? populations : 1);
    for (std::size_t p = 0; p < populations; ++p) {
        StabilityMap& map = maps[map_per_population ? p : 0];
        if (map_per_population) map.heading = all.populations[p];
        for (std::size_t x = 0; x < all.x_axis.values.size(); ++x) {
            for (std::size_t line = 0; line < all.line_axis.values.size(); ++line) {
                map.data += cell_of(plane, {x, line, p}, map_per_population ? line : populations - 1 - p);
            }
        }
    }
    return maps;
}

// Returns the labels of the y axis from the bottom up.
std::vector<std::string> labels_upwards(const SweepPlanes& all) {
    return all.line_axis.exists() ? cell_labels(all.line_axis)
                                  : std::vector<std::string>(all.populations.rbegin(), all.populations.rend());
}

double letters_px(const std::string& text) {
    constexpr double kLetter_px = 7.8;
    return kLetter_px * static_cast<double>(text.size());
}

PanelGrid grid_of(const SweepPlanes& all, const std::string& title) {
    constexpr double kCellWidth_px = 40.0;
    constexpr double kCellHeight_px = 44.0;
    constexpr double kPanelWidth_px = 250.0;
    constexpr double kPanelHeight_px = 180.0;
    constexpr double kKey_px = 150.0;
    const std::vector<std::string> labels = labels_upwards(all);
    PanelGrid grid;
    grid.columns = all.line_axis.exists() ? all.populations.size() : 1;
    grid.panel_width_px = std::max(kPanelWidth_px, kCellWidth_px * static_cast<double>(all.x_axis.values.size()));
    grid.panel_height_px = std::max(kPanelHeight_px, kCellHeight_px * static_cast<double>(labels.size()));
    grid.left_px = 75.0;
    if (!all.line_axis.exists()) {
        for (const std::string& label : labels) grid.left_px = std::max(grid.left_px, 25.0 + letters_px(label));
    }
    grid.right_px = kKey_px;
    grid.between_columns_px = 48.0;
    grid.top_px = (title.empty() ? 4.0 : 34.0) + (all.line_axis.exists() ? 32.0 : 10.0);
    grid.bottom_px = 56.0;
    grid.right_px = std::max(kKey_px, kKey_px + letters_px(title) - grid.width_px());
    return grid;
}

// Returns the commands that draw one map from the data in `file`.
std::string map_text(const SweepPlanes& all, const std::string& file, bool with_key) {
    std::string plots;
    const bool counted = all.seeds > 1;
    for (std::size_t k = 0; k < kMarks.size(); ++k) {
        plots += fmt::format(
            "'{0}' using 1:($3=={1}?$2:NaN):($1-0.5):($1+0.5):($2-0.5):($2+0.5) with boxxyerror lc rgb '{2}' dt 1 fs solid 1 border "
            "lc rgb 'white' notitle, '{0}' using 1:($3=={1}?$2{3}:NaN) with points pt {4} ps 1.9 lc rgb '{5}' notitle, ",
            file, k, kMarks[k].fill, counted ? "+0.16" : "", kMarks[k].point, kMarks[k].colour);
        if (with_key) {
            plots += fmt::format("NaN with points pt {} ps 1.9 lc rgb '{}' title '{}', ", kMarks[k].point,
                                 kMarks[k].colour, kStabilityNames[k]);
        }
    }
    if (counted) plots += fmt::format("'{}' using 1:($2-0.27):4 with labels font ',10' notitle, ", file);
    return (with_key ? "set key at graph 1.03,graph 1 left top spacing 1.6\nplot " : "unset key\nplot ") + plots +
           "NaN notitle\n";
}

}  // namespace

Figure sweep_stability_figure(const SweepPlanes& all, const SweepPlane& plane, std::size_t number) {
    Figure figure;
    figure.name = fmt::format("stability_{}", number);
    const std::string title = all.title(plane, "each cell: worst result of {} seeds, and share of seeds with it");
    const PanelGrid grid = grid_of(all, title);
    figure.width_px = grid.width_px();
    figure.height_px = grid.height_px();
    std::string body = fmt::format("set multiplot{}\nset xlabel {}\nset ylabel {}\n",
                                   title.empty() ? "" : " title " + gnuplot_text(title),
                                   gnuplot_text(all.x_axis.label()), gnuplot_text(all.line_axis.label())) +
                       cell_axes(cell_labels(all.x_axis), labels_upwards(all), grid);
    const std::vector<StabilityMap> maps = maps_of(all, plane);
    for (std::size_t k = 0; k < maps.size(); ++k) {
        const std::string file = fmt::format("{}_{}.dat", figure.name, k);
        figure.data.emplace_back(
            file, "# x index, y index, 0 stable 1 semi-stable 2 unstable, seeds with this result / all seeds\n" +
                      maps[k].data);
        body += grid.margins(k, 0) + fmt::format("set title {} offset 0,-0.5\n", gnuplot_text(maps[k].heading)) +
                map_text(all, file, k + 1 == maps.size()) + "unset ylabel\n";
    }
    figure.body = body + "unset multiplot\n";
    return figure;
}

}  // namespace stopline
