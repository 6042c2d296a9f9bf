// A list of numbers that is made anew in each step: room for all that can come is there before, so that appending takes no decision that a
// processor could foresee wrongly.
#pragma once

#include <cstddef>
#include <vector>

namespace stopline {

class NumberList {
public:
    // Empties it, with room for as many.
    void start(std::size_t room) {
        if (numbers_.size() < room + kAtOnce) numbers_.resize(2 * room + kAtOnce);
        size_ = 0;
    }
    void add(int number) { numbers_[size_++] = number; }
    void add_if(bool condition, int number) {
        numbers_[size_] = number;
        size_ += condition ? 1U : 0U;
    }
    // `from`, `from` + 1 and so on, before `to`.
    void add_all(int from, int to) {
        for (std::size_t k = 0; k < kAtOnce; ++k) numbers_[size_ + k] = from + static_cast<int>(k);
        for (int k = from + static_cast<int>(kAtOnce); k < to; ++k) {
            numbers_[size_ + static_cast<std::size_t>(k - from)] = k;
        }
        size_ += static_cast<std::size_t>(to > from ? to - from : 0);
    }

    std::size_t size() const { return size_; }
    int operator[](std::size_t k) const { return numbers_[k]; }
    int last_or(int other) const { return size_ == 0 ? other : numbers_[size_ - 1]; }
    const int* begin() const { return numbers_.data(); }
    const int* end() const { return numbers_.data() + size_; }

private:
    static constexpr std::size_t kAtOnce = 4;  // written whether needed or not

    std::vector<int> numbers_ = std::vector<int>(kAtOnce);
    std::size_t size_ = 0;
};

}  // namespace stopline
