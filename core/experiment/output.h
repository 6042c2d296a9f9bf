// Files that are whole or not there (base/replaced_file.h), and folders for them.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace stopline {

// Makes the folder, with its parents, and makes sure that files can be made in it. To be called before a long run, not after.
// Throws InputError with path and reason.
void prepare_folder(const std::filesystem::path& folder);

// Replaces the file, or leaves it as it was and throws InputError with path and reason. What is there but not a regular file
// (a device, a pipe) is written to, not replaced.
void write_file(const std::filesystem::path& file, std::string_view text);

// The whole text of a file; throws InputError with path and reason.
std::string read_file(const std::filesystem::path& file);

}  // namespace stopline
