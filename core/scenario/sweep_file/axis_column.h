// Makes the texts that stand for the values of a sweep axis in the result table and in the titles of figures.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenario/sweep_file/sweep_settings.h"

namespace stopline {

// Returns axis.values[value] as texts, one for each path of the axis, in the unit of the field. Equal quantities such
// as 60 s and 1 min give equal texts.
std::vector<std::string> axis_parts(const SweepAxis& axis, std::size_t value);

// The column of an axis in the result table. A cell shows the value of the first path of the axis. A quantity is shown
// as a number, and its unit is part of the column name, such as 5 in turns_percent. If two cells would be equal, each
// cell shows the values of all paths instead, such as "5 % / 10 %", and the column name has no unit.
struct AxisColumn {
    std::string name;
    std::vector<std::string> cells;   // [value] text in the result table
    std::vector<std::string> titles;  // [value] values of all paths, such as "5 % / 10 %" or "saturated, left 5 %"
};
AxisColumn axis_column(const SweepAxis& axis);

}  // namespace stopline
