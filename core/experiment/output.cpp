#include "experiment/output.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

#include <fmt/format.h>

#include "base/input_error.h"

namespace stopline {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const char* what, int error) {
    throw InputError(fmt::format("{}: {}: {}", path.string(), what, std::generic_category().message(error)));
}

// An open file that is closed at the end of the scope.
class Descriptor {
public:
    Descriptor(const fs::path& path, const fs::path& shown, int flags)
        : value_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {
        if (value_ < 0) fail(shown, "cannot write", errno);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    Descriptor(Descriptor&&) = delete;
    Descriptor& operator=(Descriptor&&) = delete;
    ~Descriptor() {
        if (value_ >= 0) ::close(value_);
    }

    int value() const { return value_; }
    // Some file systems report a full disk only here.
    int close() {
        const int result = ::close(value_);
        value_ = -1;
        return result;
    }

private:
    int value_;
};

void write_all(Descriptor& descriptor, const fs::path& path, std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(descriptor.value(), text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(path, "cannot write", errno);
        text.remove_prefix(static_cast<std::size_t>(written));
    }
}

void write_in_place(const fs::path& path, const fs::path& shown, std::string_view text) {
    Descriptor descriptor(path, shown, O_WRONLY);
    write_all(descriptor, shown, text);
    if (descriptor.close() != 0) fail(shown, "cannot write", errno);
}

void write_new(const fs::path& path, const fs::path& shown, std::string_view text) {
    Descriptor descriptor(path, shown, O_WRONLY | O_CREAT | O_TRUNC);
    write_all(descriptor, shown, text);
    if (::fsync(descriptor.value()) != 0) fail(shown, "cannot write", errno);
    if (descriptor.close() != 0) fail(shown, "cannot write", errno);
}

}  // namespace

void prepare_folder(const fs::path& folder) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) fail(folder, "cannot make the folder", error.value());
    if (!fs::is_directory(folder)) fail(folder, "cannot make the folder", ENOTDIR);
    if (::access(folder.c_str(), W_OK | X_OK) != 0) fail(folder, "cannot write into the folder", errno);
}

void write_file(const fs::path& file, std::string_view text) {
    std::error_code error;
    const fs::path target = fs::weakly_canonical(file, error);  // through links, so that they stay
    if (error) fail(file, "cannot write", error.value());
    if (fs::is_directory(target)) fail(file, "cannot write", EISDIR);
    if (fs::exists(target) && !fs::is_regular_file(target)) return write_in_place(target, file, text);
    const fs::path beside = target.parent_path() / fmt::format(".{}.{}.part", target.filename().string(), ::getpid());
    try {
        write_new(beside, file, text);
        fs::rename(beside, target, error);
        if (error) fail(file, "cannot write", error.value());
    } catch (...) {
        fs::remove(beside, error);
        throw;
    }
}

std::string read_file(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream || fs::is_directory(file)) {
        throw InputError(fmt::format("{}: cannot read: {}", file.string(),
                                     std::generic_category().message(fs::is_directory(file) ? EISDIR : errno)));
    }
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

}  // namespace stopline
