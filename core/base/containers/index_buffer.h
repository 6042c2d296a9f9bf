// A list of indices that every simulation step empties and fills again. The caller tells reset() the largest number of
// indices, so the functions that append indices do not check the capacity.
#pragma once

#include <cstddef>
#include <vector>

namespace stopline {

class IndexBuffer {
public:
    // Empties the list and reserves memory for `capacity` indices.
    void reset(std::size_t capacity) {
        if (indices_.size() < capacity + kUnconditional) indices_.resize(capacity + capacity / 4 + kUnconditional);
        size_ = 0;
    }
    void push(int index) { indices_[size_++] = index; }
    void push_if(bool condition, int index) {
        indices_[size_] = index;
        size_ += condition ? 1U : 0U;
    }
    // Appends the indices from `first` to `end` - 1.
    void push_range(int first, int end) {
        for (std::size_t k = 0; k < kUnconditional; ++k) indices_[size_ + k] = first + static_cast<int>(k);
        for (int k = first + static_cast<int>(kUnconditional); k < end; ++k) {
            indices_[size_ + static_cast<std::size_t>(k - first)] = k;
        }
        size_ += static_cast<std::size_t>(end > first ? end - first : 0);
    }

    std::size_t size() const { return size_; }
    int operator[](std::size_t k) const { return indices_[k]; }
    int last_or(int other) const { return size_ == 0 ? other : indices_[size_ - 1]; }
    const int* begin() const { return indices_.data(); }
    const int* end() const { return indices_.data() + size_; }

private:
    // push_range() writes this many elements even if its range is shorter.
    static constexpr std::size_t kUnconditional = 4;

    std::vector<int> indices_ = std::vector<int>(kUnconditional);
    std::size_t size_ = 0;
};

}  // namespace stopline
