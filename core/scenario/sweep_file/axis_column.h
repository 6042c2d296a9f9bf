// Names of the values of an axis in the table of results and in titles.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenario/sweep_file/sweep_settings.h"

namespace stopline {

// Returns the value of each field that one value of the axis sets, in the unit of the field. Values that mean the same
// give the same texts, such as 60 s and 1 min.
std::vector<std::string> axis_parts(const SweepAxis& axis, std::size_t value);

// The column of an axis in the table of results. If an axis sets several fields, the first field represents them as a
// number in a column with a unit, such as 5 in turns_percent. If its values are not all different, a cell lists all
// fields: "5 % / 10 %".
struct AxisColumn {
    std::string name;
    std::vector<std::string> cells;   // [value]
    std::vector<std::string> titles;  // [value], all fields: "5 % / 10 %", "saturated, left 5 %"
};
AxisColumn axis_column(const SweepAxis& axis);

}  // namespace stopline
