// The standard streams of a program, and messages on standard error.
#pragma once

#include <string>
#include <utility>

#include <fmt/format.h>

namespace stopline {

// Opens /dev/null in place of each standard stream that is closed. Otherwise the next file that the program opens would
// get its number, and messages would be written into this file. Call it first in main().
void open_closed_streams();

// Writes text to standard error. Ignores failures, because a message that cannot be shown must not end a program.
void write_message(const std::string& text);

// Formats a text and writes it to standard error.
template <class... Arguments>
void print_message(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    write_message(fmt::format(format, std::forward<Arguments>(arguments)...));
}

}  // namespace stopline
