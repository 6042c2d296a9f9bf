// NumberList: what is added is listed in order, and nothing else, whatever was written beyond it.
#include "base/number_list.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace stopline {
namespace {

std::vector<int> numbers(const NumberList& list) { return {list.begin(), list.end()}; }

TEST(NumberList, ListsWhatIsAddedInOrder) {
    NumberList list;
    EXPECT_EQ(list.last_or(-7), -7);
    list.start(12);
    list.add(5);
    list.add_if(false, 6);
    list.add_if(true, 7);
    list.add_all(8, 8);
    list.add_all(9, 4);
    EXPECT_EQ(numbers(list), (std::vector<int>{5, 7}));
    list.add_all(10, 12);
    list.add_all(20, 27);
    EXPECT_EQ(numbers(list), (std::vector<int>{5, 7, 10, 11, 20, 21, 22, 23, 24, 25, 26}));
    EXPECT_EQ(list.last_or(-7), 26);
    list.start(1);
    EXPECT_EQ(list.size(), 0U);
}

TEST(NumberList, HasRoomForAsManyAsAskedFor) {
    for (const int room : {0, 1, 3, 4, 5, 100}) {
        NumberList list;
        list.start(static_cast<std::size_t>(room));
        list.add_all(0, room);
        list.add_all(room, room);
        list.add_if(false, 0);
        ASSERT_EQ(list.size(), static_cast<std::size_t>(room));
        for (int k = 0; k < room; ++k) EXPECT_EQ(list[static_cast<std::size_t>(k)], k);
    }
}

}  // namespace
}  // namespace stopline
