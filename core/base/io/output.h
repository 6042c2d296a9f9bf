// Reading and writing of whole files, and preparation of output folders.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace stopline {

// Creates the folder and its parents, and checks that files can be created in the folder. Removes temporary files that
// killed programs left in it. On failure it throws InputError with path and reason. Call the function before a long
// run, so that a wrong path is reported before the run starts.
void prepare_folder(const std::filesystem::path& folder);

// Checks that the file can be written, and creates its folder. Leaves an existing file unchanged. On failure it throws
// InputError with path and reason. Call the function before long work, as prepare_folder().
void prepare_output_file(const std::filesystem::path& file);

// Writes the file atomically (see base/io/replaced_file.h); a device or a pipe is written directly. On failure the old
// content of the file remains, and the function throws InputError with path and reason.
void write_file(const std::filesystem::path& file, std::string_view text);

// Returns the text of a file. Throws InputError with path and reason if the file cannot be read.
std::string read_file(const std::filesystem::path& file);

}  // namespace stopline
