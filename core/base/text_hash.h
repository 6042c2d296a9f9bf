// FNV-1a: a 64-bit hash of texts, which is the same on every platform.
#pragma once

#include <cstdint>
#include <string_view>

namespace stopline {

inline constexpr std::uint64_t kEmptyTextHash = 0xcbf29ce484222325U;

// Returns `hash` extended by one character, or by the hash of another text.
constexpr std::uint64_t extended_hash(std::uint64_t hash, std::uint64_t part) { return (hash ^ part) * 0x100000001b3U; }
constexpr std::uint64_t extended_hash(std::uint64_t hash, char character) {
    return extended_hash(hash, std::uint64_t{static_cast<unsigned char>(character)});
}

constexpr std::uint64_t hash_of(std::string_view text) {
    std::uint64_t hash = kEmptyTextHash;
    for (const char c : text) hash = extended_hash(hash, c);
    return hash;
}

}  // namespace stopline
