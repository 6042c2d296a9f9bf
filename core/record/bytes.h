// Little-endian numbers in a string of bytes. Reading beyond the end, or a number that cannot be meant, is an InputError.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/input_error.h"

namespace stopline {

template <class Number>
void put_number(std::string& bytes, Number number) {
    for (std::size_t k = 0; k < sizeof(Number); ++k) bytes += static_cast<char>((number >> (8 * k)) & 0xFFU);
}

inline void put_varint(std::string& bytes, std::uint64_t number) {
    for (; number >= 0x80U; number >>= 7U) bytes += static_cast<char>((number & 0x7FU) | 0x80U);
    bytes += static_cast<char>(number);
}

class ByteReader {
public:
    explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

    std::size_t left() const { return bytes_.size() - next_; }

    std::string_view take(std::size_t count) {
        if (count > left()) throw InputError("it ends too early");
        next_ += count;
        return bytes_.substr(next_ - count, count);
    }

    template <class Number>
    Number number() {
        Number value = 0;
        std::size_t shift = 0;
        for (const char c : take(sizeof(Number))) {
            value = static_cast<Number>(
                value | static_cast<Number>(static_cast<Number>(static_cast<unsigned char>(c)) << shift));
            shift += 8;
        }
        return value;
    }

    // At most `most`.
    std::uint64_t varint(std::uint64_t most) {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 64; shift += 7) {
            const auto byte = static_cast<unsigned char>(take(1).front());
            value |= static_cast<std::uint64_t>(byte & 0x7FU) << shift;
            if ((byte & 0x80U) == 0) {
                if (value > most) throw InputError("a number in it is too large");
                return value;
            }
        }
        throw InputError("a number in it is too long");
    }
    int whole(std::size_t below) {
        if (below == 0) throw InputError("a number in it is too large");
        return static_cast<int>(varint(below - 1));
    }

private:
    std::string_view bytes_;
    std::size_t next_ = 0;
};

}  // namespace stopline
