#include "figures/studies/surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "figures/studies/cells.h"

namespace stopline {

namespace {

using Palette = std::vector<std::string>;  // colours at equal distances, from minimum to maximum

struct ColourScale {
    Palette palette;
    double min = 0.0;
    double max = 1.0;
    int decimals = 0;
    bool signs = false;  // true: positive numbers are written with a plus sign
};

// Returns the palette viridis. Its lightness rises with the value, also for colour-blind readers and in grey print.
Palette ordered_palette() {
    constexpr std::size_t kColours = 8;
    Palette palette;
    for (std::size_t k = 0; k < kColours; ++k) palette.push_back(ordered_colour(k, kColours));
    return palette;
}

// Returns a palette from red to blue if a positive change is an improvement, otherwise a palette from orange to purple.
Palette diverging_palette(bool improves) {
    if (improves) return {"#b2182b", "#ef8a62", "#fddbc7", "#f7f7f7", "#d1e5f0", "#67a9cf", "#2166ac"};
    return {"#b35806", "#f1a340", "#fee0b6", "#f7f7f7", "#d8daeb", "#998ec3", "#542788"};
}

// Returns the number of decimals with which the largest value has about three digits.
int decimals_for(double largest) {
    constexpr double kWhole = 100.0;
    constexpr double kTenths = 10.0;
    return largest >= kWhole ? 0 : largest >= kTenths ? 1 : 2;
}

struct Panel {
    std::size_t metric;
    std::size_t population;
    bool change;  // true: changes against the baseline; false: values
};

std::optional<double> value_in(const SweepPlanes& all, const SweepPlane& plane, const Panel& panel, std::size_t x,
                               std::size_t line) {
    const double sign = all.metrics[panel.metric].sign();
    const PlanePoint point{x, line, panel.population};
    const std::optional<SeedSpread> spread =
        panel.change ? plane.change(panel.metric, point, sign) : plane.value(panel.metric, point);
    return spread ? std::optional(spread->mean) : std::nullopt;
}

// Returns one colour scale for all populations, so that equal colours mean equal values.
ColourScale scale_of(const SweepPlanes& all, const SweepPlane& plane, std::size_t metric, bool change) {
    std::vector<double> values;
    for (std::size_t p = change ? 1 : 0; p < all.populations.size(); ++p) {
        for (std::size_t x = 0; x < all.x_axis.values.size(); ++x) {
            for (std::size_t line = 0; line < all.line_axis.values.size(); ++line) {
                const auto value = value_in(all, plane, {metric, p, change}, x, line);
                if (value) values.push_back(*value);
            }
        }
    }
    ColourScale scale;
    scale.signs = change;
    scale.palette = change ? diverging_palette(all.metrics[metric].improves()) : ordered_palette();
    if (values.empty()) return scale;
    const auto [min, max] = std::minmax_element(values.begin(), values.end());
    const double largest = std::max(std::abs(*min), std::abs(*max));
    scale.decimals = change ? std::min(1, decimals_for(largest)) : decimals_for(largest);
    scale.min = change ? -largest : *min;
    scale.max = change ? largest : *max;
    if (scale.min < scale.max) return scale;
    scale.min -= 1.0;  // gnuplot cannot draw an empty range
    scale.max += 1.0;
    return scale;
}

using Rgb = std::array<double, 3>;  // 0 .. 255

Rgb rgb_of(const std::string& colour) {
    constexpr int kHex = 16;
    return {static_cast<double>(std::stoi(colour.substr(1, 2), nullptr, kHex)),
            static_cast<double>(std::stoi(colour.substr(3, 2), nullptr, kHex)),
            static_cast<double>(std::stoi(colour.substr(5, 2), nullptr, kHex))};
}

// Returns the colour of the text on a cell: black or white, whichever has more contrast. Relative luminance and
// contrast are those of WCAG 2, with gamma 2.2.
int ink_on(const ColourScale& scale, double value) {
    constexpr double kEqualContrast = 0.179;
    constexpr double kGamma = 2.2;
    constexpr Rgb kWeights{0.2126, 0.7152, 0.0722};
    const double position =
        (value - scale.min) / (scale.max - scale.min) * static_cast<double>(scale.palette.size() - 1);
    const std::size_t below = std::min(static_cast<std::size_t>(position), scale.palette.size() - 2);
    const Rgb from = rgb_of(scale.palette[below]);
    const Rgb to = rgb_of(scale.palette[below + 1]);
    const double share = position - static_cast<double>(below);
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

// Returns one line for each cell that has a value: index on both axes, the value, its text and the colour of the text.
std::string cells_of(const SweepPlanes& all, const SweepPlane& plane, const Panel& panel, const ColourScale& scale) {
    std::string text;
    for (std::size_t x = 0; x < all.x_axis.values.size(); ++x) {
        for (std::size_t line = 0; line < all.line_axis.values.size(); ++line) {
            const std::optional<double> value = value_in(all, plane, panel, x, line);
            if (!value) continue;
            text +=
                fmt::format("{} {} {:.6g} {} {}\n", x, line, *value, number_of(scale, *value), ink_on(scale, *value));
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
        for (const SweepMetric& metric : all.metrics) {
            const std::size_t letters = (population + ", " + all.change_label(metric)).size();
            title_px = std::max(title_px, kLetter_px * static_cast<double>(letters));
        }
    }
    PanelGrid grid;
    grid.columns = all.metrics.size();
    grid.rows = 2 * all.populations.size() - 1;
    grid.between_columns_px = 92.0;
    grid.between_rows_px = 62.0;
    grid.panel_width_px = std::max({kPanelWidth_px, kCellWidth_px * static_cast<double>(all.x_axis.values.size()),
                                    title_px - grid.between_columns_px});
    grid.panel_height_px = std::max(kPanelHeight_px, kCellHeight_px * static_cast<double>(all.line_axis.values.size()));
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
    return fmt::format("set palette defined ({})\nset cbrange [{:g}:{:g}]\n", text, scale.min, scale.max);
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
    std::string data = fmt::format("# index of {}, index of {}, value, text, colour of the text\n", all.x_axis.name,
                                   all.line_axis.name);
    std::string body =
        fmt::format("set multiplot{}\n", title.empty() ? "" : " title " + gnuplot_text(title)) +
        cell_axes(cell_labels(all.x_axis), cell_labels(all.line_axis), grid) +
        "unset key\nset tics font ',11'\nset colorbox user origin graph 1.025,graph 0 size graph 0.03,graph 1\n"
        "set cbtics font ',9' offset -0.8,0 scale 0.3\n";
    std::size_t blocks = 0;
    for (std::size_t row = 0; row < grid.rows; ++row) {
        const bool change = row >= all.populations.size();
        const std::size_t population = change ? row - all.populations.size() + 1 : row;
        for (std::size_t metric = 0; metric < all.metrics.size(); ++metric) {
            const SweepMetric& shown = all.metrics[metric];
            const ColourScale scale = scale_of(all, plane, metric, change);
            const std::string cells = cells_of(all, plane, {metric, population, change}, scale);
            const std::string heading =
                all.populations[population] + ", " + (change ? all.change_label(shown) : shown.label());
            body += grid.margins(metric, row) + palette_text(scale) +
                    fmt::format("set title {} font ',11' offset 0,-0.6\nset xlabel {}\nset ylabel {}\n",
                                gnuplot_text(heading), row + 1 == grid.rows ? gnuplot_text(all.x_axis.label()) : "''",
                                metric == 0 ? gnuplot_text(all.line_axis.label()) : "''");
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
