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

TEST(Marks, AreFoundClearedAndVisitedByWord) {
    Marks marks;
    marks.resize(192);
    marks.set(3), marks.set(70), marks.set(71), marks.set(191);
    EXPECT_TRUE(marks.has(70));
    EXPECT_FALSE(marks.has(6));  // of another word
    const std::vector<NumbersOfWord> numbers{{0, 1U << 4U}, {1, 1U << 6U}};
    EXPECT_TRUE(marks.has_any(numbers));  // 70
    EXPECT_FALSE(marks.has_any(std::span(numbers).first(1)));
    std::vector<std::size_t> seen;
    marks.keep_if(1, 2, [&](std::size_t number) {
        seen.push_back(number);
        return number == 70;
    });
    EXPECT_EQ(seen, (std::vector<std::size_t>{70, 71}));
    marks.clear_word_of(100);
    EXPECT_EQ(visited(marks, 1), (std::vector<std::size_t>{3, 191}));
}

}  // namespace
}  // namespace stopline
