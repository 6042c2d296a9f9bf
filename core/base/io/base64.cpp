#include "base/io/base64.h"

#include <cstddef>
#include <cstdint>

namespace stopline {

std::string encode_base64(std::string_view bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t k = 0; k < bytes.size(); k += 3) {
        const auto byte = [&](std::size_t i) {
            return k + i < bytes.size() ? static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[k + i])) : 0U;
        };
        const std::uint32_t three_bytes = byte(0) << 16U | byte(1) << 8U | byte(2);
        for (std::size_t i = 0; i < 4; ++i) {
            text += k + i > bytes.size() ? '=' : kDigits[three_bytes >> (18U - 6U * static_cast<unsigned>(i)) & 63U];
        }
    }
    return text;
}

}  // namespace stopline
