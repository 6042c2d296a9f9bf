// Lists for a few of many keys, for example for the occupied ones among all connections. A simulation step fills the
// lists and empties them again. Their memory is kept for the next step.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "base/simd/huge_page_allocator.h"

namespace stopline {

// The caller owns the array `places`, indexed by key. It holds the place of each key's list, or kNoList if the key has
// no list. Several SparseLists may share one array if no key has a list in two of them.
template <class T>
class SparseLists {
public:
    static constexpr int kNoList = -1;

    // Appends a value to the list of a key.
    void add(int key, const T& value, LargeArray<int>& places) {
        int& place = places[static_cast<std::size_t>(key)];
        if (place == kNoList) {
            place = static_cast<int>(keys_.size());
            keys_.push_back(key);
            if (lists_.size() < keys_.size()) lists_.emplace_back();
        }
        lists_[static_cast<std::size_t>(place)].push_back(value);
    }
    // Returns the list at a place that is in the array `places`. The list at kNoList is empty.
    std::span<const T> at_place(int place) const {
        if (place == kNoList) return {};
        return lists_[static_cast<std::size_t>(place)];
    }
    // Returns the keys that have a list, in the order in which they got their first value.
    const std::vector<int>& keys() const { return keys_; }
    bool empty() const { return keys_.empty(); }
    void clear(LargeArray<int>& places) {
        for (std::size_t k = 0; k < keys_.size(); ++k) {
            places[static_cast<std::size_t>(keys_[k])] = kNoList;
            lists_[k].clear();
        }
        keys_.clear();
    }

private:
    std::vector<std::vector<T>> lists_;
    std::vector<int> keys_;
};

}  // namespace stopline
