// A 64-bit hash of the state of a simulation. Two runs whose states are equal to the last bit have equal hashes.
#pragma once

#include <bit>
#include <cstdint>

#include "base/random.h"

namespace stopline {

class StateHash {
public:
    void add(std::uint64_t bits) { value_ = mix64(value_ ^ bits); }
    void add(std::int64_t bits) { add(static_cast<std::uint64_t>(bits)); }
    void add(int bits) { add(static_cast<std::uint64_t>(static_cast<std::int64_t>(bits))); }
    void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
    void add(float number) { add(static_cast<std::uint64_t>(std::bit_cast<std::uint32_t>(number))); }
    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0x5354'4f50'4c49'4e45ULL;  // "STOPLINE" in ASCII
};

}  // namespace stopline
