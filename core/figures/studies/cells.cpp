#include "figures/studies/cells.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace stopline {

namespace {

constexpr double kLabelWidth_px = 34.0;
constexpr double kLabelHeight_px = 18.0;

std::string ticks(const char* axis, const std::vector<std::string>& labels, double length_px, double label_px) {
    const double cell_px = length_px / static_cast<double>(labels.size());
    const auto step = static_cast<std::size_t>(std::max(1.0, std::ceil(label_px / cell_px)));
    std::string text;
    for (std::size_t k = 0; k < labels.size(); k += step) {
        text += fmt::format("{}{} {}", text.empty() ? "" : ", ", gnuplot_text(labels[k]), k);
    }
    return fmt::format("set {0}range [-0.5:{1}.5]\nset {0}tics ({2})\n", axis, labels.size() - 1, text);
}

}  // namespace

int PanelGrid::width_px() const {
    const auto count = static_cast<double>(columns);
    return static_cast<int>(left_px + count * panel_width_px + (count - 1.0) * between_columns_px + right_px);
}

int PanelGrid::height_px() const {
    const auto count = static_cast<double>(rows);
    return static_cast<int>(top_px + count * panel_height_px + (count - 1.0) * between_rows_px + bottom_px);
}

std::string PanelGrid::margins(std::size_t column, std::size_t row) const {
    const double left = left_px + static_cast<double>(column) * (panel_width_px + between_columns_px);
    const double top = top_px + static_cast<double>(row) * (panel_height_px + between_rows_px);
    const auto screen_x = [&](double px) { return px / width_px(); };
    const auto screen_y = [&](double px) { return 1.0 - px / height_px(); };
    return fmt::format(
        "set lmargin at screen {:.5f}\nset rmargin at screen {:.5f}\nset tmargin at screen {:.5f}\nset bmargin at screen "
        "{:.5f}\n",
        screen_x(left), screen_x(left + panel_width_px), screen_y(top), screen_y(top + panel_height_px));
}

std::string cell_axes(const std::vector<std::string>& x_labels, const std::vector<std::string>& y_labels,
                      const PanelGrid& grid) {
    return "unset grid\n" + ticks("x", x_labels, grid.panel_width_px, kLabelWidth_px) +
           ticks("y", y_labels, grid.panel_height_px, kLabelHeight_px);
}

std::vector<std::string> cell_labels(const PlotAxis& axis) {
    std::vector<std::string> labels;
    labels.reserve(axis.values.size());
    for (const double value : axis.values) labels.push_back(fmt::format("{:g}", value));
    return labels;
}

}  // namespace stopline
