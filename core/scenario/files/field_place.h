// The place where the user has set a field, for error messages about a scenario that has been loaded.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stopline {

// Returns "file:line:column" of the value of a field such as demand.kind, "--set 'PATH=VALUE'" if an override sets it,
// or the name of the file alone if the field has its default.
std::string field_place(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                        const std::string& path);

}  // namespace stopline
