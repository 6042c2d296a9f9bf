// A set of whole numbers below a fixed limit, stored with one bit per number. Visiting all members is fast if the set
// has few members.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace stopline {

// Several numbers that share one 64-bit word of a Bitset: the index of the word, and one set bit per number.
struct BitsetMask {
    std::size_t word = 0;
    std::uint64_t bits = 0;
};

class Bitset {
public:
    static constexpr std::size_t kWordBits = 64;

    void resize(std::size_t size) { words_.resize((size + kWordBits - 1) / kWordBits, 0); }
    void set(std::size_t number) { words_[number / kWordBits] |= bit_of(number); }
    bool has(std::size_t number) const { return (words_[number / kWordBits] & bit_of(number)) != 0; }
    bool has_any(std::span<const BitsetMask> masks) const {
        return std::any_of(masks.begin(), masks.end(),
                           [this](const BitsetMask& mask) { return (words_[mask.word] & mask.bits) != 0; });
    }
    // Sets the 64-bit word of `number` to 0. This removes `number` and all other numbers that share the word.
    void clear_word_of(std::size_t number) { words_[number / kWordBits] = 0; }
    const std::uint64_t* word_of(std::size_t number) const { return &words_[number / kWordBits]; }

    // Calls visit(number) for all members in ascending order. Removes each number for which `visit` returns false.
    template <class Visit>
    void retain_if(Visit visit) {
        retain_if(0, words_.size(), visit);
    }
    // Like the function above, but visits only the members in the 64-bit words first_word .. end_word - 1.
    template <class Visit>
    void retain_if(std::size_t first_word, std::size_t end_word, Visit visit) {
        for (std::size_t k = first_word; k < end_word; ++k) {
            for (std::uint64_t left = words_[k]; left != 0; left &= left - 1) {
                const auto bit = static_cast<std::size_t>(std::countr_zero(left));
                if (!visit(k * kWordBits + bit)) words_[k] &= ~bit_of(bit);
            }
        }
    }

private:
    static std::uint64_t bit_of(std::size_t number) { return std::uint64_t{1} << number % kWordBits; }

    std::vector<std::uint64_t> words_;
};

}  // namespace stopline
