#include "experiment/network_sweep_stability.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiment/network_run.h"
#include "experiment/network_sweep_cells.h"

namespace stopline {

namespace {

struct Mark {
    const char* colour;
    const char* fill;
    int point;  // so that they can be told apart without colours too
};
constexpr std::array<Mark, kStabilityNames.size()> kMarks{Mark{"#009e73", "#cdeee3", 7}, Mark{"#e69f00", "#fbe9c3", 5},
                                                          Mark{"#d55e00", "#f5ccb2", 9}};

struct Map {
    std::string heading;
    std::string data;
};

// A line for each cell: both indices, stability, how many seeds of all were so.
std::string cell_of(const SweepPlane& plane, const SweepPlace& place, std::size_t up) {
    const auto counts = plane.stabilities(place);
    const std::size_t seeds = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
    if (seeds == 0) return "";
    std::size_t worst = counts.size() - 1;
    while (counts[worst] == 0) --worst;
    return fmt::format("{} {} {} {}/{}\n", place.across, up, worst, counts[worst], seeds);
}

// One for each population; with one axis a single one, the first population at the top.
std::vector<Map> maps_of(const SweepPlanes& all, const SweepPlane& plane) {
    const bool each = all.lines.there();
    const std::size_t populations = all.populations.size();
    std::vector<Map> maps(each ? populations : 1);
    for (std::size_t p = 0; p < populations; ++p) {
        Map& map = maps[each ? p : 0];
        if (each) map.heading = all.populations[p];
        for (std::size_t across = 0; across < all.across.values.size(); ++across) {
            for (std::size_t line = 0; line < all.lines.values.size(); ++line) {
                map.data += cell_of(plane, {across, line, p}, each ? line : populations - 1 - p);
            }
        }
    }
    return maps;
}

// From the bottom.
std::vector<std::string> labels_upwards(const SweepPlanes& all) {
    return all.lines.there() ? cell_labels(all.lines)
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
    grid.columns = all.lines.there() ? all.populations.size() : 1;
    grid.panel_width_px = std::max(kPanelWidth_px, kCellWidth_px * static_cast<double>(all.across.values.size()));
    grid.panel_height_px = std::max(kPanelHeight_px, kCellHeight_px * static_cast<double>(labels.size()));
    grid.left_px = 75.0;
    if (!all.lines.there()) {
        for (const std::string& label : labels) grid.left_px = std::max(grid.left_px, 25.0 + letters_px(label));
    }
    grid.right_px = kKey_px;
    grid.between_columns_px = 48.0;
    grid.top_px = (title.empty() ? 4.0 : 34.0) + (all.lines.there() ? 32.0 : 10.0);
    grid.bottom_px = 56.0;
    grid.right_px = std::max(kKey_px, kKey_px + letters_px(title) - grid.width_px());
    return grid;
}

// Commands that draw one map; its data is in `file`.
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
    const std::string title = all.title(plane, "each cell: the worst of {} seeds, and how many of them were so");
    const PanelGrid grid = grid_of(all, title);
    figure.width_px = grid.width_px();
    figure.height_px = grid.height_px();
    std::string body = fmt::format("set multiplot{}\nset xlabel {}\nset ylabel {}\n",
                                   title.empty() ? "" : " title " + gnuplot_text(title),
                                   gnuplot_text(all.across.label()), gnuplot_text(all.lines.label())) +
                       cell_axes(cell_labels(all.across), labels_upwards(all), grid);
    const std::vector<Map> maps = maps_of(all, plane);
    for (std::size_t k = 0; k < maps.size(); ++k) {
        const std::string file = fmt::format("{}_{}.dat", figure.name, k);
        figure.data.emplace_back(
            file, "# cell across, cell upwards, 0 stable 1 semi-stable 2 unstable, seeds that are so of all\n" +
                      maps[k].data);
        body += grid.margins(k, 0) + fmt::format("set title {} offset 0,-0.5\n", gnuplot_text(maps[k].heading)) +
                map_text(all, file, k + 1 == maps.size()) + "unset ylabel\n";
    }
    figure.body = body + "unset multiplot\n";
    return figure;
}

}  // namespace stopline
