// Encoding of bytes as base64 text (RFC 4648, section 4).
#pragma once

#include <string>
#include <string_view>

namespace stopline {

// Returns the bytes as base64 text with padding and without line breaks.
std::string encode_base64(std::string_view bytes);

}  // namespace stopline
