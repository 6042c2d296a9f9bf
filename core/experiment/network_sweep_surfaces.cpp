#include "experiment/network_sweep_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "experiment/network_sweep_cells.h"

namespace stopline {

namespace {

using Palette = std::vector<std::string>;  // colours at equal distances, from the least value to the greatest

struct ColourScale {
    Palette palette;
    double least = 0.0;
    double greatest = 1.0;
    int decimals = 0;
    bool signs = false;
};

// Viridis: lighter with the value for every reader, in print without colours too.
Palette ordered_palette() {
    constexpr std::size_t kColours = 8;
    Palette palette;
    for (std::size_t k = 0; k < kColours; ++k) palette.push_back(ordered_colour(k, kColours));
    return palette;
}

// Red to blue where plus is better, orange to purple where it is neither.
Palette diverging_palette(bool improves) {
    if (improves) return {"#b2182b", "#ef8a62", "#fddbc7", "#f7f7f7", "#d1e5f0", "#67a9cf", "#2166ac"};
    return {"#b35806", "#f1a340", "#fee0b6", "#f7f7f7", "#d8daeb", "#998ec3", "#542788"};
}

// As many as tell the values apart in few characters.
int decimals_for(double greatest) {
    constexpr double kWhole = 100.0;
    constexpr double kTenths = 10.0;
    return greatest >= kWhole ? 0 : greatest >= kTenths ? 1 : 2;
}

struct Panel {
    std::size_t metric;
    std::size_t population;
    bool change;  // from the first population
};

std::optional<double> value_in(const SweepPlane& plane, const Panel& panel, std::size_t across, std::size_t line) {
    const SweepPlace place{across, line, panel.population};
    const std::optional<SeedSpread> spread =
        panel.change ? plane.change(panel.metric, place) : plane.value(panel.metric, place);
    return spread ? std::optional(spread->mean) : std::nullopt;
}

// Of all populations, so that equal colours are equal values.
ColourScale scale_of(const SweepPlanes& all, const SweepPlane& plane, std::size_t metric, bool change) {
    std::vector<double> values;
    for (std::size_t p = change ? 1 : 0; p < all.populations.size(); ++p) {
        for (std::size_t across = 0; across < all.across.values.size(); ++across) {
            for (std::size_t line = 0; line < all.lines.values.size(); ++line) {
                const auto value = value_in(plane, {metric, p, change}, across, line);
                if (value) values.push_back(*value);
            }
        }
    }
    ColourScale scale;
    scale.signs = change;
    scale.palette = change ? diverging_palette(kSweepMetrics[metric].improves) : ordered_palette();
    if (values.empty()) return scale;
    const auto [least, greatest] = std::minmax_element(values.begin(), values.end());
    const double largest = std::max(std::abs(*least), std::abs(*greatest));
    scale.decimals = change ? std::min(1, decimals_for(largest)) : decimals_for(largest);
    scale.least = change ? -largest : *least;
    scale.greatest = change ? largest : *greatest;
    if (scale.least < scale.greatest) return scale;
    scale.least -= 1.0;  // gnuplot wants a range
    scale.greatest += 1.0;
    return scale;
}

using Rgb = std::array<double, 3>;  // 0 .. 255

Rgb rgb_of(const std::string& colour) {
    constexpr int kHex = 16;
    return {static_cast<double>(std::stoi(colour.substr(1, 2), nullptr, kHex)),
            static_cast<double>(std::stoi(colour.substr(3, 2), nullptr, kHex)),
            static_cast<double>(std::stoi(colour.substr(5, 2), nullptr, kHex))};
}

// Black or white, whichever has more contrast: relative luminance and contrast as in WCAG 2, with a plain gamma of 2.2.
int ink_on(const ColourScale& scale, double value) {
    constexpr double kEqualContrast = 0.179;
    constexpr double kGamma = 2.2;
    constexpr Rgb kWeights{0.2126, 0.7152, 0.0722};
    const double place =
        (value - scale.least) / (scale.greatest - scale.least) * static_cast<double>(scale.palette.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(place), scale.palette.size() - 2);
    const Rgb from = rgb_of(scale.palette[below]);
    const Rgb to = rgb_of(scale.palette[below + 1]);
    const double share = place - static_cast<double>(below);
    double luminance = 0.0;
    for (std::size_t k = 0; k < kWeights.size(); ++k) {
        luminance += kWeights[k] * std::pow((from[k] + share * (to[k] - from[k])) / 255.0, kGamma);
    }
    return luminance > kEqualContrast ? 0x000000 : 0xffffff;
}

std::string number_of(const ColourScale& scale, double value) {
    std::string text = fmt::format("{:.{}f}", value, scale.decimals);
    const bool zero = text.find_first_not_of("-0.") == std::string::npos;
    if (zero && text.front() == '-') text.erase(0, 1);
    return (scale.signs && value > 0.0 && !zero ? "+" : "") + text;
}

// A line for each cell that has a value: both indices, the value, how it is written and the colour of that.
std::string cells_of(const SweepPlanes& all, const SweepPlane& plane, const Panel& panel, const ColourScale& scale) {
    std::string text;
    for (std::size_t across = 0; across < all.across.values.size(); ++across) {
        for (std::size_t line = 0; line < all.lines.values.size(); ++line) {
            const std::optional<double> value = value_in(plane, panel, across, line);
            if (!value) continue;
            text += fmt::format("{} {} {:.6g} {} {}\n", across, line, *value, number_of(scale, *value),
                                ink_on(scale, *value));
        }
    }
    return text;
}

PanelGrid grid_of(const SweepPlanes& all, bool titled) {
    constexpr double kCellWidth_px = 48.0;
    constexpr double kCellHeight_px = 28.0;
    constexpr double kPanelWidth_px = 300.0;
    constexpr double kPanelHeight_px = 120.0;
    constexpr double kLetter_px = 6.9;
    double title_px = 0.0;
    for (const std::string& population : all.populations) {
        for (const SweepMetric& metric : kSweepMetrics) {
            const std::size_t letters = (population + ", " + all.change_label(metric)).size();
            title_px = std::max(title_px, kLetter_px * static_cast<double>(letters));
        }
    }
    PanelGrid grid;
    grid.columns = kSweepMetrics.size();
    grid.rows = 2 * all.populations.size() - 1;
    grid.between_columns_px = 92.0;
    grid.between_rows_px = 62.0;
    grid.panel_width_px = std::max({kPanelWidth_px, kCellWidth_px * static_cast<double>(all.across.values.size()),
                                    title_px - grid.between_columns_px});
    grid.panel_height_px = std::max(kPanelHeight_px, kCellHeight_px * static_cast<double>(all.lines.values.size()));
    grid.left_px = 75.0;
    grid.right_px = 75.0;
    grid.top_px = titled ? 66.0 : 34.0;
    grid.bottom_px = 54.0;
    return grid;
}

std::string palette_text(const ColourScale& scale) {
    std::string text;
    for (std::size_t k = 0; k < scale.palette.size(); ++k) {
        text += fmt::format("{}{} '{}'", k == 0 ? "" : ", ", k, scale.palette[k]);
    }
    return fmt::format("set palette defined ({})\nset cbrange [{:g}:{:g}]\n", text, scale.least, scale.greatest);
}

}  // namespace

Figure sweep_surfaces_figure(const SweepPlanes& all, const SweepPlane& plane, std::size_t number) {
    Figure figure;
    figure.name = fmt::format("surfaces_{}", number);
    const std::string title = all.title(plane, "means of {} seeds");
    const PanelGrid grid = grid_of(all, !title.empty());
    figure.width_px = grid.width_px();
    figure.height_px = grid.height_px();
    const std::string file = figure.name + ".dat";
    std::string data =
        fmt::format("# cell of {}, of {}, value, as it is written, colour of that\n", all.across.name, all.lines.name);
    std::string body =
        fmt::format("set multiplot{}\n", title.empty() ? "" : " title " + gnuplot_text(title)) +
        cell_axes(cell_labels(all.across), cell_labels(all.lines), grid) +
        "unset key\nset tics font ',11'\nset colorbox user origin graph 1.025,graph 0 size graph 0.03,graph 1\n"
        "set cbtics font ',9' offset -0.8,0 scale 0.3\n";
    std::size_t blocks = 0;
    for (std::size_t row = 0; row < grid.rows; ++row) {
        const bool change = row >= all.populations.size();
        const std::size_t population = change ? row - all.populations.size() + 1 : row;
        for (std::size_t metric = 0; metric < kSweepMetrics.size(); ++metric) {
            const SweepMetric& of = kSweepMetrics[metric];
            const ColourScale scale = scale_of(all, plane, metric, change);
            const std::string cells = cells_of(all, plane, {metric, population, change}, scale);
            const std::string heading =
                all.populations[population] + ", " + (change ? all.change_label(of) : of.label());
            body += grid.margins(metric, row) + palette_text(scale) +
                    fmt::format("set title {} font ',11' offset 0,-0.6\nset xlabel {}\nset ylabel {}\n",
                                gnuplot_text(heading), row + 1 == grid.rows ? gnuplot_text(all.across.label()) : "''",
                                metric == 0 ? gnuplot_text(all.lines.label()) : "''");
            if (cells.empty()) {
                body += "plot NaN notitle\n";
                continue;
            }
            data += "# " + heading + "\n" + cells + "\n\n";
            body += fmt::format(
                "plot '{0}' index {1} using 1:2:($1-0.5):($1+0.5):($2-0.5):($2+0.5):3 with boxxyerror lc palette dt 1 fs solid 1 "
                "border lc rgb 'white', '{0}' index {1} using 1:2:4:5 with labels tc rgb variable font ',10'\n",
                file, blocks++);
        }
    }
    figure.data.emplace_back(file, data);
    figure.body = body + "unset multiplot\n";
    return figure;
}

}  // namespace stopline
