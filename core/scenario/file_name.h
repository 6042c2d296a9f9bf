// Default names of scenarios and sweeps, made from their file names.
#pragma once

#include <filesystem>
#include <string>

namespace stopline {

// Returns the file name without extension, with '_' for each character that a name may not have. Returns `otherwise` if
// the file name is empty.
inline std::string name_from_file(const std::string& label, const std::string& otherwise) {
    std::string name;
    for (const char c : std::filesystem::path(label).stem().string().substr(0, 64)) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        name += plain || c == '-' || c == '_' || c == '.' || c == '+' ? c : '_';
    }
    return name.empty() ? otherwise : name;
}

}  // namespace stopline
