// The rows of a delay line (DelayLine) that are written and read in one step.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim/state/model.h"

namespace stopline {

// Offsets of rows in an array [row][slot]. `now` is the row of the present sample. The delayed value is interpolated
// between two samples: the one in the row `delayed` and the one a step before it, in the row `older`.
struct DelayRows {
    std::size_t now = 0, delayed = 0, older = 0;
    double delayed_share = 1.0, older_share = 0.0;  // weights of the rows `delayed` and `older`
};
// Returns the rows of a delay line at a tick.
DelayRows delay_rows_at(const DelayLine& line, std::int64_t tick, int slots);

}  // namespace stopline
