// The rows of a delay line at one tick.
#pragma once

#include <cstddef>
#include <cstdint>

#include "sim/state/model.h"

namespace stopline {

// Offsets into [row][slot] arrays: the row of the present sample and the two rows between which the delayed sample
// lies.
struct DelayRows {
    std::size_t now = 0, delayed = 0, older = 0;
    double delayed_share = 1.0, older_share = 0.0;  // weights of the two rows
};
DelayRows delay_rows_at(const DelayLine& line, std::int64_t tick, int slots);

}  // namespace stopline
