// The slots that one lane owns in the vehicle arrays.
#pragma once

namespace stopline {

// A lane owns the slots [begin, end). Its vehicles use consecutive slots, the vehicle furthest downstream first. The
// slot before the first vehicle is the sentinel: it holds a copy of the first vehicle's leader, which is on a lane
// downstream.
struct LaneBlock {
    int begin = 0;  // at least 1, because the sentinel can be in slot begin - 1; full dynamics: multiple of kSimdWidth
    int end = 0;    // slot after the last slot of the lane
    int first = 0;  // slot of the vehicle furthest downstream
    int count = 0;  // number of vehicles

    int last() const { return first + count - 1; }
    int past_last() const { return first + count; }
    bool has(int slot) const { return slot >= first && slot < past_last(); }
};

}  // namespace stopline
