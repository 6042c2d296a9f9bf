// Compression in a format that browsers can decompress.
#pragma once

#include <string>
#include <string_view>

namespace stopline {

// Returns the bytes compressed by zlib.
std::string compress_zlib(std::string_view bytes);

}  // namespace stopline
