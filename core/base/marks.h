// Which of the numbers 0 .. n - 1 are marked, visited in ascending order: a bit each, so that few marks among many numbers cost little.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace stopline {

// Some of the numbers that share a word.
struct NumbersOfWord {
    std::size_t word = 0;
    std::uint64_t bits = 0;
};

class Marks {
public:
    static constexpr std::size_t kBits = 64;  // numbers that share a word

    void resize(std::size_t n) { words_.resize((n + kBits - 1) / kBits, 0); }
    void set(std::size_t number) { words_[number / kBits] |= bit_of(number); }
    bool has(std::size_t number) const { return (words_[number / kBits] & bit_of(number)) != 0; }
    bool has_any(std::span<const NumbersOfWord> numbers) const {
        return std::any_of(numbers.begin(), numbers.end(),
                           [this](const NumbersOfWord& n) { return (words_[n.word] & n.bits) != 0; });
    }
    // All that share its word.
    void clear_word_of(std::size_t number) { words_[number / kBits] = 0; }
    const std::uint64_t* word_of(std::size_t number) const { return &words_[number / kBits]; }

    // visit(number): true: it stays marked.
    template <class Visit>
    void keep_if(Visit visit) {
        keep_if(0, words_.size(), visit);
    }
    // The same of words [from, to).
    template <class Visit>
    void keep_if(std::size_t from, std::size_t to, Visit visit) {
        for (std::size_t k = from; k < to; ++k) {
            for (std::uint64_t left = words_[k]; left != 0; left &= left - 1) {
                const auto bit = static_cast<std::size_t>(std::countr_zero(left));
                if (!visit(k * kBits + bit)) words_[k] &= ~bit_of(bit);
            }
        }
    }

private:
    static std::uint64_t bit_of(std::size_t number) { return std::uint64_t{1} << number % kBits; }

    std::vector<std::uint64_t> words_;
};

}  // namespace stopline
