// Tests of IndexBuffer: it lists the pushed indices in order. push_if() and push_range() may write past the end of the
// list, but such a write adds no entry.
#include "base/containers/index_buffer.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace stopline {
namespace {

std::vector<int> indices_of(const IndexBuffer& list) { return {list.begin(), list.end()}; }

TEST(IndexBuffer, ListsPushedIndicesInOrder) {
    IndexBuffer list;
    EXPECT_EQ(list.last_or(-7), -7);
    list.reset(12);
    list.push(5);
    list.push_if(false, 6);
    list.push_if(true, 7);
    list.push_range(8, 8);
    list.push_range(9, 4);
    EXPECT_EQ(indices_of(list), (std::vector<int>{5, 7}));
    list.push_range(10, 12);
    list.push_range(20, 27);
    EXPECT_EQ(indices_of(list), (std::vector<int>{5, 7, 10, 11, 20, 21, 22, 23, 24, 25, 26}));
    EXPECT_EQ(list.last_or(-7), 26);
    list.reset(1);
    EXPECT_EQ(list.size(), 0U);
}

TEST(IndexBuffer, HoldsTheReservedCapacity) {
    for (const int capacity : {0, 1, 3, 4, 5, 100}) {
        IndexBuffer list;
        list.reset(static_cast<std::size_t>(capacity));
        list.push_range(0, capacity);
        list.push_range(capacity, capacity);
        list.push_if(false, 0);
        ASSERT_EQ(list.size(), static_cast<std::size_t>(capacity));
        for (int k = 0; k < capacity; ++k) EXPECT_EQ(list[static_cast<std::size_t>(k)], k);
    }
}

}  // namespace
}  // namespace stopline
