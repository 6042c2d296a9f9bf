// Layout of cell maps: one cell for each pair of axis values. All cells have the same size, whatever the distance
// between the values, so that each cell has room for its text. Sizes are in pixels, because the size of the figure is
// computed from the numbers of panels and cells.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "figures/gnuplot.h"
#include "figures/studies/planes.h"

namespace stopline {

// Panels of equal size in rows and columns.
struct PanelGrid {
    std::size_t columns = 1;
    std::size_t rows = 1;
    double panel_width_px = 0.0;
    double panel_height_px = 0.0;
    double left_px = 0.0;
    double right_px = 0.0;
    double top_px = 0.0;
    double bottom_px = 0.0;
    double between_columns_px = 0.0;
    double between_rows_px = 0.0;

    int width_px() const;
    int height_px() const;
    // Returns the gnuplot commands that place a panel. Row 0 is at the top.
    std::string margins(std::size_t column, std::size_t row) const;
};

// Returns the gnuplot commands for ranges and tick labels. Cells are centred at 0, 1, ... on both axes. Labels are
// skipped if they would overlap.
std::string cell_axes(const std::vector<std::string>& x_labels, const std::vector<std::string>& y_labels,
                      const PanelGrid& grid);

// Returns the values of an axis as text.
std::vector<std::string> cell_labels(const PlotAxis& axis);

}  // namespace stopline
