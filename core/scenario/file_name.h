// Names after files, for scenarios and sweeps that give themselves none.
#pragma once

#include <filesystem>
#include <string>

namespace stopline {

// The file's name without extension, what cannot stand in a name replaced; `otherwise` where nothing is left.
inline std::string name_from_file(const std::string& label, const std::string& otherwise) {
    std::string name;
    for (const char c : std::filesystem::path(label).stem().string().substr(0, 64)) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
        name += plain || c == '-' || c == '_' || c == '.' || c == '+' ? c : '_';
    }
    return name.empty() ? otherwise : name;
}

}  // namespace stopline
