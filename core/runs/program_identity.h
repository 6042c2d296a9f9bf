// Identifies the exact build of the program that made a result, so that results of different builds are never mixed.
#pragma once

#include <optional>
#include <string>

namespace stopline {

// Returns "stopline VERSION, program HASH". HASH is a hash of the program file. Returns std::nullopt if the program
// file cannot be read.
std::optional<std::string> program_identity();

}  // namespace stopline
