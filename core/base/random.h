// Counter-based random numbers. A number is a function of its key (seed, vehicle, tick, purpose) alone. The number of
// threads, the spacing policies (car-following rules) of the vehicles and the order of the calls do not change the
// number. So two runs with different spacing policies can use the same random numbers.
//
// The function that maps a key to its random bits is the 64-bit finaliser of SplitMix64 (Steele, Lea, Flood 2014, "Fast
// splittable pseudorandom number generators"), applied once for each part of the key. The function uses integer
// arithmetic only, so compilers can vectorise it and its results have the same bits on every machine.
#pragma once

#include <bit>
#include <cstdint>

namespace stopline {

// The purpose of a random number. The value of the enumerator is part of the key, so append new purposes and never
// renumber old ones.
enum class Purpose : std::uint64_t {
    policy = 1,
    turn = 2,
    dawdle = 3,
    insertion = 4,
    vehicle_type = 5,
    fit_start = 6,
    driver = 7,
    v2v = 8,
    courtesy = 9,
    arrival = 10
};

// Returns the SplitMix64 finaliser of z. `Words` is std::uint64_t or a vector of std::uint64_t.
template <class Words>
[[gnu::always_inline]] constexpr Words mix_bits(Words z) {
    z += std::uint64_t{0x9e3779b97f4a7c15};
    z = (z ^ (z >> 30)) * std::uint64_t{0xbf58476d1ce4e5b9};
    z = (z ^ (z >> 27)) * std::uint64_t{0x94d049bb133111eb};
    return z ^ (z >> 31);
}
constexpr std::uint64_t mix64(std::uint64_t z) { return mix_bits(z); }

// Returns the 64 random bits that belong to a key.
constexpr std::uint64_t random_bits(std::uint64_t seed, std::uint64_t vehicle, std::uint64_t tick, Purpose purpose) {
    return mix64(mix64(mix64(seed ^ (static_cast<std::uint64_t>(purpose) << 56)) ^ vehicle) ^ tick);
}

// Returns a uniform number in [0, 1) with 53 random bits.
constexpr double random_uniform(std::uint64_t seed, std::uint64_t vehicle, std::uint64_t tick, Purpose purpose) {
    return static_cast<double>(random_bits(seed, vehicle, tick, purpose) >> 11) * 0x1.0p-53;
}

// The next functions make random numbers that kernels compute for several vehicles at once. A key combines the seed and
// the purpose, which are the same for all vehicles. The numbers have 52 random bits, because every instruction set can
// vectorise the conversion of 52 bits to a double.
constexpr std::uint64_t purpose_key(std::uint64_t seed, Purpose purpose) {
    return mix64(seed ^ (static_cast<std::uint64_t>(purpose) << 56));
}
// Key for Krauss's model, in which drivers dawdle (brake at random). The index of the numbers is the tick.
constexpr std::uint64_t dawdle_key(std::uint64_t seed) { return purpose_key(seed, Purpose::dawdle); }
// Key for the properties and errors of human drivers (driver/human.h).
constexpr std::uint64_t driver_key(std::uint64_t seed) { return purpose_key(seed, Purpose::driver); }
// Key for the loss and the delay of V2V messages (v2v/channel.h).
constexpr std::uint64_t v2v_key(std::uint64_t seed) { return purpose_key(seed, Purpose::v2v); }
// Returns the bits of a double that is uniformly distributed in [1, 2).
template <class Words>
[[gnu::always_inline]] constexpr Words keyed_bits(std::uint64_t key, Words vehicle, std::uint64_t index) {
    return std::uint64_t{0x3ff0000000000000} | (mix_bits(mix_bits(key ^ vehicle) ^ index) >> 12);
}
// Returns a uniform number in [0, 1) with 52 random bits.
inline double keyed_uniform(std::uint64_t key, int vehicle, std::uint64_t index) {
    return std::bit_cast<double>(keyed_bits(key, static_cast<std::uint64_t>(vehicle), index)) - 1.0;
}

}  // namespace stopline
