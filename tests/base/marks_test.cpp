// Marks: visited in ascending order, kept or taken away one by one, across the words that they are stored in.
#include "base/marks.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace stopline {
namespace {

std::vector<std::size_t> visited(Marks& marks, std::size_t keep_multiples_of) {
    std::vector<std::size_t> numbers;
    marks.keep_if([&](std::size_t number) {
        numbers.push_back(number);
        return number % keep_multiples_of == 0;
    });
    return numbers;
}

TEST(Marks, AreVisitedInOrderAndStayWhereKept) {
    Marks marks;
    marks.resize(130);
    for (const std::size_t number : {129U, 64U, 0U, 63U, 65U, 64U}) marks.set(number);
    EXPECT_EQ(visited(marks, 1), (std::vector<std::size_t>{0, 63, 64, 65, 129}));
    EXPECT_EQ(visited(marks, 64), (std::vector<std::size_t>{0, 63, 64, 65, 129}));
    EXPECT_EQ(visited(marks, 1), (std::vector<std::size_t>{0, 64}));
    marks.set(1);
    EXPECT_EQ(visited(marks, 1), (std::vector<std::size_t>{0, 1, 64}));
}

}  // namespace
}  // namespace stopline
