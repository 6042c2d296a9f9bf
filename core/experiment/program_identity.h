// Which program made a result, to the byte: a result of another program is never taken for one of this.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace stopline {

// 64-bit FNV-1a.
std::uint64_t hash_of(std::string_view bytes);

// "stopline VERSION, program HASH", the hash over the bytes of the running program. Nothing where it cannot be read.
std::optional<std::string> program_identity();

}  // namespace stopline
