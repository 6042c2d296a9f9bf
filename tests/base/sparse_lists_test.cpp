#include "base/containers/sparse_lists.h"

#include <vector>

#include <gtest/gtest.h>

namespace stopline {
namespace {

class SparseListsTest : public testing::Test {
protected:
    std::vector<int> of(int key) const {
        const auto list = lists_.at_place(places_[static_cast<std::size_t>(key)]);
        return {list.begin(), list.end()};
    }

    LargeArray<int> places_ = LargeArray<int>(5, SparseLists<int>::kNoList);
    SparseLists<int> lists_;
};

TEST_F(SparseListsTest, KeepsTheOrderOfValuesAndKeys) {
    lists_.add(3, 30, places_);
    lists_.add(1, 10, places_);
    lists_.add(3, 31, places_);
    EXPECT_EQ(of(3), (std::vector<int>{30, 31}));
    EXPECT_EQ(of(1), std::vector<int>{10});
    EXPECT_EQ(of(0), std::vector<int>());
    EXPECT_EQ(lists_.keys(), (std::vector<int>{3, 1}));
}

TEST_F(SparseListsTest, ClearRemovesAllLists) {
    lists_.add(3, 30, places_);
    lists_.add(1, 10, places_);
    lists_.clear(places_);
    EXPECT_TRUE(lists_.empty());
    for (int key = 0; key < 5; ++key) EXPECT_EQ(of(key), std::vector<int>()) << key;
    lists_.add(1, 11, places_);
    EXPECT_EQ(of(1), std::vector<int>{11});
}

}  // namespace
}  // namespace stopline
