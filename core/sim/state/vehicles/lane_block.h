// The slots of one lane in the vehicle arrays.
#pragma once

namespace stopline {

// A lane owns the slots [begin, end). Its vehicles use consecutive slots, the vehicle furthest downstream first.
struct LaneBlock {
    int begin = 0;  // 1 or more; full dynamics: a multiple of kSimdWidth
    int end = 0;
    int first = 0;  // slot of the vehicle furthest downstream
    int count = 0;  // vehicles

    int last() const { return first + count - 1; }
    int past_last() const { return first + count; }
    bool has(int slot) const { return slot >= first && slot < past_last(); }
};

}  // namespace stopline
