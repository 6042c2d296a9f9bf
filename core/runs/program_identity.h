// Identifies the program that made a result to the byte, so that results of different builds are never mixed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace stopline {

// Returns the 64-bit FNV-1a hash of the bytes.
std::uint64_t hash_of(std::string_view bytes);

// Returns "stopline VERSION, program HASH" with a hash over the bytes of the running program; nothing if the program
// file cannot be read.
std::optional<std::string> program_identity();

}  // namespace stopline
