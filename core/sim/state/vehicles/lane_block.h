// The slots that one lane owns in the vehicle arrays.
#pragma once

namespace stopline {

// A lane owns the slots [begin, end). Its vehicles use consecutive slots, the vehicle furthest downstream first.
struct LaneBlock {
    int begin = 0;  // at least 1, since the slot before may hold the sentinel; full dynamics: a multiple of kSimdWidth
    int end = 0;    // slot after the last one of the block
    int first = 0;  // slot of the vehicle furthest downstream
    int count = 0;  // number of vehicles

    int last() const { return first + count - 1; }
    int past_last() const { return first + count; }
    bool has(int slot) const { return slot >= first && slot < past_last(); }
};

}  // namespace stopline
