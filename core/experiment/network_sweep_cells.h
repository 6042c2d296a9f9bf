// Maps of a sweep with a cell for each pair of values: cells are of one size however far apart the values are, so that each has room for what is
// written into it. Panels are placed to the pixel, since their number and size follow from the sweep.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "experiment/gnuplot.h"
#include "experiment/network_sweep_planes.h"

namespace stopline {

// Panels of one size in rows and columns.
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
    std::string margins(std::size_t column, std::size_t row) const;  // commands; row 0 is at the top
};

// Ranges and ticks of a map; cells are at 0, 1, ... of both axes. Labels that would not fit beside one another are left out.
std::string cell_axes(const std::vector<std::string>& across, const std::vector<std::string>& up,
                      const PanelGrid& grid);

// Of an axis that figures are drawn over: its values.
std::vector<std::string> cell_labels(const DrawnAxis& axis);

}  // namespace stopline
