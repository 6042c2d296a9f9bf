// How an axis of fields stands in the table of results and in titles.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenario/sweep_settings.h"

namespace stopline {

// What a value of the axis sets, field by field, in the units in which the fields are shown. Alike where two values mean the same.
std::vector<std::string> axis_parts(const SweepAxis& axis, std::size_t value);

// Fields that are set together are represented by the first one where that tells all values apart, as a number in a column with a
// unit ("5" in turns_percent); else a cell has all of them: "5 % / 10 %".
struct AxisColumn {
    std::string name;
    std::vector<std::string> cells;   // [value]
    std::vector<std::string> titles;  // [value] all fields in words: "5 % / 10 %", "saturated, left 5 %"
};
AxisColumn axis_column(const SweepAxis& axis);

}  // namespace stopline
