// Lists of different lengths, stored one after the other in one array.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "base/simd/huge_page_allocator.h"

namespace stopline {

template <class T>
class PackedLists {
public:
    // Appends a list. Lists are numbered from 0 in the order in which they are added.
    template <class List>
    void add(const List& list) {
        elements_.insert(elements_.end(), list.begin(), list.end());
        offsets_.push_back(static_cast<std::uint32_t>(elements_.size()));
    }
    std::span<const T> of(int list) const {
        const std::size_t first = offsets_[static_cast<std::size_t>(list)];
        return {elements_.data() + first, offsets_[static_cast<std::size_t>(list) + 1] - first};
    }
    std::span<T> of(int list) {
        const std::size_t first = offsets_[static_cast<std::size_t>(list)];
        return {elements_.data() + first, offsets_[static_cast<std::size_t>(list) + 1] - first};
    }

    // Calls visit(begin, end) for the two memory ranges that belong to a list: its offsets, then its elements. The
    // caller prefetches these ranges.
    template <class Visit>
    void visit_memory(int list, Visit visit) const {
        visit_offsets(list, visit);
        visit(of(list).data(), of(list).data() + of(list).size());
    }
    // Calls visit(begin, end) for the memory range of the list's offsets only.
    template <class Visit>
    void visit_offsets(int list, Visit visit) const {
        visit(offsets_.data() + list, offsets_.data() + list + 2);
    }

private:
    LargeArray<T> elements_;
    LargeArray<std::uint32_t> offsets_{0};
};

}  // namespace stopline
