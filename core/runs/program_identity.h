// Identifies the exact build of the program that made a result, so that results of different builds are never mixed.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace stopline {

// Returns the 64-bit FNV-1a hash of the bytes.
std::uint64_t hash_of(std::string_view bytes);

// Returns "stopline VERSION, program HASH". HASH is a hash of the program file. Returns std::nullopt if the program
// file cannot be read.
std::optional<std::string> program_identity();

}  // namespace stopline
