#include "replay/packing.h"

#include <stdexcept>

#include <zlib.h>

namespace stopline {

std::string deflated(std::string_view bytes) {
    constexpr int kLevel = 6;
    uLongf size = compressBound(bytes.size());
    std::string packed(size, '\0');
    auto* const to = reinterpret_cast<Bytef*>(packed.data());
    const auto* const from = reinterpret_cast<const Bytef*>(bytes.data());
    if (compress2(to, &size, from, bytes.size(), kLevel) != Z_OK) throw std::runtime_error("zlib cannot compress");
    packed.resize(size);
    return packed;
}

std::string base64(std::string_view bytes) {
    static constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t k = 0; k < bytes.size(); k += 3) {
        const std::string_view three = bytes.substr(k, 3);
        unsigned bits = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            bits = (bits << 8U) | (i < three.size() ? static_cast<unsigned char>(three[i]) : 0U);
        }
        for (std::size_t i = 0; i < 4; ++i) {
            text += i <= three.size() ? kDigits[(bits >> (18U - 6U * static_cast<unsigned>(i))) & 63U] : '=';
        }
    }
    return text;
}

}  // namespace stopline
