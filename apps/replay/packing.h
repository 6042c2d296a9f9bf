// Bytes as a browser can unpack them from the text of a page: zlib, then base64.
#pragma once

#include <string>
#include <string_view>

namespace stopline {

std::string deflated(std::string_view bytes);
std::string base64(std::string_view bytes);

}  // namespace stopline
