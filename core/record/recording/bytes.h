// Writes and reads little-endian numbers in a string of bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "base/input_error.h"

namespace stopline {

// Appends all bytes of an unsigned number, the lowest byte first.
template <class Number>
void put_number(std::string& bytes, Number number) {
    for (std::size_t k = 0; k < sizeof(Number); ++k) bytes += static_cast<char>((number >> (8 * k)) & 0xFFU);
}

// Appends a number with 7 bits per byte, the lowest bits first. The highest bit of a byte is set if another byte of the
// same number follows.
inline void put_varint(std::string& bytes, std::uint64_t number) {
    for (; number >= 0x80U; number >>= 7U) bytes += static_cast<char>((number & 0x7FU) | 0x80U);
    bytes += static_cast<char>(number);
}

// Reads numbers from bytes, one after the other. All functions throw InputError if the bytes end before the number is
// complete, or if the number is out of range.
class ByteReader {
public:
    explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

    std::size_t remaining() const { return bytes_.size() - next_; }

    std::string_view take(std::size_t count) {
        if (count > remaining()) throw InputError("the data end too early");
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

    // Reads a number that put_varint() wrote. The number must not be above `max`.
    std::uint64_t varint(std::uint64_t max) {
        std::uint64_t value = 0;
        for (unsigned shift = 0; shift < 64; shift += 7) {
            const auto byte = static_cast<unsigned char>(take(1).front());
            value |= static_cast<std::uint64_t>(byte & 0x7FU) << shift;
            if ((byte & 0x80U) == 0) {
                if (value > max) throw InputError("a number is too large");
                return value;
            }
        }
        throw InputError("a number has more than 10 bytes");
    }
    // Reads an index that put_varint() wrote. The index must be below `size`.
    int index(std::size_t size) {
        if (size == 0) throw InputError("an index refers to an empty list");
        return static_cast<int>(varint(size - 1));
    }

private:
    std::string_view bytes_;
    std::size_t next_ = 0;
};

}  // namespace stopline
