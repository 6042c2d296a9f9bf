// Reading and writing of whole files, and preparation of output folders.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace stopline {

// Creates the folder and its parents, and checks that files can be created in it. Call it before a long run, so that a
// wrong path is found early. Throws InputError with path and reason.
void prepare_folder(const std::filesystem::path& folder);

// Writes the file atomically (see base/io/replaced_file.h). On failure the old content remains, and an InputError with
// path and reason is thrown. A device or a pipe is written directly.
void write_file(const std::filesystem::path& file, std::string_view text);

// Returns the text of a file. Throws InputError with path and reason.
std::string read_file(const std::filesystem::path& file);

}  // namespace stopline
