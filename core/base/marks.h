// Which of the numbers 0 .. n - 1 are marked, visited in ascending order: a bit each, so that few marks among many numbers cost little.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace stopline {

class Marks {
public:
    void resize(std::size_t n) { words_.resize((n + kBits - 1) / kBits, 0); }
    void set(std::size_t number) { words_[number / kBits] |= std::uint64_t{1} << number % kBits; }

    // visit(number): true: it stays marked.
    template <class Visit>
    void keep_if(Visit visit) {
        for (std::size_t k = 0; k < words_.size(); ++k) {
            for (std::uint64_t left = words_[k]; left != 0; left &= left - 1) {
                const auto bit = static_cast<std::size_t>(std::countr_zero(left));
                if (!visit(k * kBits + bit)) words_[k] &= ~(std::uint64_t{1} << bit);
            }
        }
    }

private:
    static constexpr std::size_t kBits = 64;
    std::vector<std::uint64_t> words_;
};

}  // namespace stopline
