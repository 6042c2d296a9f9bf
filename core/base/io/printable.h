// Text that is safe to print on a terminal.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace stopline {

// Returns the length of the UTF-8 sequence at `i`, in bytes. Returns 0 for invalid bytes, overlong forms and
// surrogates.
std::size_t utf8_length(std::string_view text, std::size_t i);

// Returns true if the text has characters that can change the state of a terminal or the order of its letters, or bytes
// that are not UTF-8. Line breaks and tabs are harmless.
bool has_control_characters(std::string_view text);

// Replaces each byte of such characters by its hexadecimal code, such as \x1B. A name from a file thus cannot move the
// cursor, change colours or hide a part of a message.
std::string printable_text(std::string_view text);

}  // namespace stopline
