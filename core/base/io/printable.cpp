#include "base/io/printable.h"

#include <algorithm>

#include <fmt/format.h>

namespace stopline {

namespace {

// Returns the length of the harmless character at `i`, in bytes. Returns 0 for control characters and invalid bytes.
std::size_t harmless_length(std::string_view text, std::size_t i) {
    const std::size_t length = utf8_length(text, i);
    const auto byte = static_cast<unsigned char>(text[i]);
    if (length == 1) return (byte >= 0x20 && byte != 0x7F) || byte == '\n' || byte == '\t' ? 1 : 0;
    const std::string_view character = text.substr(i, length);
    const auto is_between = [&](std::string_view first, std::string_view last) {
        return character.size() == first.size() && character >= first && character <= last;
    };
    const bool is_control = is_between("\xC2\x80", "\xC2\x9F");  // U+0080 .. U+009F
    // U+202A .. U+202E and U+2066 .. U+2069 change the direction of writing, U+2028 and U+2029 break the line.
    const bool is_layout = is_between("\xE2\x80\xA8", "\xE2\x80\xAE") || is_between("\xE2\x81\xA6", "\xE2\x81\xA9");
    return is_control || is_layout ? 0 : length;
}

}  // namespace

std::size_t utf8_length(std::string_view text, std::size_t i) {
    const auto byte = [&](std::size_t k) { return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u; };
    const unsigned first = byte(i);
    if (first < 0x80) return 1;
    const std::size_t length = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
    if (first < 0xC2 || first > 0xF4) return 0;
    for (std::size_t k = 1; k < length; ++k) {
        if ((byte(i + k) & 0xC0u) != 0x80u) return 0;
    }
    const unsigned second = byte(i + 1);
    if (first == 0xE0 && second < 0xA0) return 0;
    if (first == 0xED && second > 0x9F) return 0;
    if (first == 0xF0 && second < 0x90) return 0;
    if (first == 0xF4 && second > 0x8F) return 0;
    return length;
}

bool has_control_characters(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = harmless_length(text, i);
        if (length == 0) return true;
        i += length;
    }
    return false;
}

std::string printable_text(std::string_view text) {
    std::string printable;
    printable.reserve(text.size());
    for (std::size_t i = 0; i < text.size();) {
        if (const std::size_t length = harmless_length(text, i); length > 0) {
            printable += text.substr(i, length);
            i += length;
            continue;
        }
        const std::size_t stop = i + std::max<std::size_t>(utf8_length(text, i), 1);
        for (; i < stop; ++i) printable += fmt::format("\\x{:02X}", static_cast<unsigned char>(text[i]));
    }
    return printable;
}

}  // namespace stopline
