// Makes the default name of a scenario or a sweep from its file name.
#pragma once

#include <filesystem>
#include <string>

namespace stopline {

// Returns the file name without extension, cut to 64 characters. Replaces each character that names must not contain by
// '_'. Returns `otherwise` if the file name is empty.
inline std::string name_from_file(const std::string& label, const std::string& otherwise) {
    std::string name;
    for (const char c : std::filesystem::path(label).stem().string().substr(0, 64)) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        name += plain || c == '-' || c == '_' || c == '.' || c == '+' ? c : '_';
    }
    return name.empty() ? otherwise : name;
}

}  // namespace stopline
