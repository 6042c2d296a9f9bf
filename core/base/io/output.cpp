#include "base/io/output.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstddef>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

#include "base/input_error.h"
#include "base/io/replaced_file.h"

namespace stopline {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const char* what, int error) {
    throw InputError(fmt::format("{}: {}: {}", path.string(), what, std::generic_category().message(error)));
}

}  // namespace

void prepare_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) fail(folder, "cannot create the folder", error.value());
    if (!fs::is_directory(folder)) fail(folder, "cannot create the folder", ENOTDIR);
    if (::access(folder.c_str(), W_OK | X_OK) != 0) fail(folder, "cannot write into the folder", errno);
    remove_stale_parts(folder);
}

void prepare_output_file(const fs::path& file) {
    if (!file.has_filename()) {
        throw InputError(fmt::format("'{}' is a folder; add the name of a file to it", file.string()));
    }
    std::error_code ignored;
    const fs::file_status status = fs::status(file, ignored);
    if (fs::is_directory(status)) fail(file, "cannot write", EISDIR);
    if (fs::exists(status) && !fs::is_regular_file(status)) {  // a device or a pipe
        // The file is not opened, because opening a pipe would wait for its reader.
        if (::access(file.c_str(), W_OK) != 0) fail(file, "cannot write", errno);
        return;
    }
    prepare_folder(file.has_parent_path() ? file.parent_path() : ".");
    const ReplacedFile trial(file);  // its destructor removes the temporary file
}

void write_file(const fs::path& file, std::string_view text) {
    ReplacedFile replaced(file);
    replaced.write(text);
    replaced.commit();
}

std::string read_file(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream || fs::is_directory(file)) {
        throw InputError(fmt::format("{}: cannot read: {}", file.string(),
                                     std::generic_category().message(fs::is_directory(file) ? EISDIR : errno)));
    }
    std::string text;
    std::array<char, 65536> part;
    do {
        stream.read(part.data(), part.size());
        text.append(part.data(), static_cast<std::size_t>(stream.gcount()));
    } while (stream);
    if (stream.bad()) {
        throw InputError(fmt::format("{}: cannot read: {}", file.string(), std::generic_category().message(errno)));
    }
    return text;
}

}  // namespace stopline
