// Counter-based random numbers keyed by (seed, vehicle, tick, purpose): the same numbers whatever the thread count, the
// policy or the order of visits, so that two policies can be compared on common random numbers. No state, no sequence.
//
// The mixer is the 64-bit finaliser of SplitMix64 (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number
// generators"), applied once per key word. Integer arithmetic only, so it vectorises and is the same on every machine.
#pragma once

#include <bit>
#include <cstdint>

namespace stopline {

// What a number is drawn for. Append only: the values enter the key.
enum class Purpose : std::uint64_t { policy = 1, turn = 2, dawdle = 3, insertion = 4, vehicle_type = 5, fit_start = 6 };

// `Words`: one word, or a vector of them.
template <class Words>
[[gnu::always_inline]] constexpr Words mixed(Words z) {
    z += std::uint64_t{0x9e3779b97f4a7c15};
    z = (z ^ (z >> 30)) * std::uint64_t{0xbf58476d1ce4e5b9};
    z = (z ^ (z >> 27)) * std::uint64_t{0x94d049bb133111eb};
    return z ^ (z >> 31);
}
constexpr std::uint64_t mix64(std::uint64_t z) { return mixed(z); }

constexpr std::uint64_t random_bits(std::uint64_t seed, std::uint64_t vehicle, std::uint64_t tick, Purpose purpose) {
    return mix64(mix64(mix64(seed ^ (static_cast<std::uint64_t>(purpose) << 56)) ^ vehicle) ^ tick);
}

// Uniform in [0, 1), 53 bits.
constexpr double random_uniform(std::uint64_t seed, std::uint64_t vehicle, std::uint64_t tick, Purpose purpose) {
    return static_cast<double>(random_bits(seed, vehicle, tick, purpose) >> 11) * 0x1.0p-53;
}

// The same in two halves, for loops over vehicles: what all vehicles have in common, and the rest. 52 bits: the conversion is
// one that every instruction set has for vectors.
constexpr std::uint64_t dawdle_key(std::uint64_t seed) {
    return mix64(seed ^ (static_cast<std::uint64_t>(Purpose::dawdle) << 56));
}
// The bits of a number in [1, 2).
template <class Words>
[[gnu::always_inline]] constexpr Words dawdle_bits(std::uint64_t key, Words vehicle, std::uint64_t tick) {
    return std::uint64_t{0x3ff0000000000000} | (mixed(mixed(key ^ vehicle) ^ tick) >> 12);
}
inline double dawdle_uniform(std::uint64_t key, int vehicle, std::uint64_t tick) {
    return std::bit_cast<double>(dawdle_bits(key, static_cast<std::uint64_t>(vehicle), tick)) - 1.0;
}

}  // namespace stopline
