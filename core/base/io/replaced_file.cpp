#include "base/io/replaced_file.h"

#include <fcntl.h>
#include <signal.h>  // declares the POSIX function kill()
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <optional>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "base/input_error.h"

namespace stopline {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTemporarySuffix = ".part";

[[noreturn]] void fail(const fs::path& path, int error) {
    throw InputError(fmt::format("{}: cannot write: {}", path.string(), std::generic_category().message(error)));
}

// Returns the path of the temporary file, in the folder of the target. The name contains the process id, because
// several programs may write the same target at the same time.
fs::path temporary_path(const fs::path& target) {
    return target.parent_path() / fmt::format(".{}.{}{}", target.filename().string(), ::getpid(), kTemporarySuffix);
}

// Returns the id of the process that wrote the temporary file `name`, or nothing if `name` is no temporary file.
std::optional<pid_t> writer_of(const std::string& name) {
    if (!name.starts_with('.') || !name.ends_with(kTemporarySuffix)) return std::nullopt;
    const std::string rest = name.substr(0, name.size() - kTemporarySuffix.size());
    const char* const begin = rest.data() + rest.rfind('.') + 1;
    const char* const end = rest.data() + rest.size();
    pid_t writer = 0;
    const auto [stop, error] = std::from_chars(begin, end, writer);
    if (error != std::errc() || stop != end || begin == rest.data() + 1 || writer <= 0) return std::nullopt;
    return writer;
}

bool is_running(pid_t process) { return ::kill(process, 0) == 0 || errno != ESRCH; }

}  // namespace

ReplacedFile::ReplacedFile(const fs::path& file) : shown_(file) {
    std::error_code error;
    target_ = fs::weakly_canonical(file, error);
    if (error) fail(shown_, error.value());
    if (fs::is_directory(target_)) fail(shown_, EISDIR);
    const bool in_place = fs::exists(target_) && !fs::is_regular_file(target_);
    if (!in_place) temporary_ = temporary_path(target_);
    const int flags = in_place ? O_WRONLY : O_WRONLY | O_CREAT | O_TRUNC;
    descriptor_ = ::open((in_place ? target_ : temporary_).c_str(), flags | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail(shown_, errno);
}

ReplacedFile::~ReplacedFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
    std::error_code ignored;
    if (!temporary_.empty()) fs::remove(temporary_, ignored);
}

void ReplacedFile::write(std::string_view bytes) {
    size_ += bytes.size();
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail(shown_, errno);
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

void ReplacedFile::commit() {
    if (temporary_.empty()) return close();
    if (::fsync(descriptor_) != 0) fail(shown_, errno);
    close();
    std::error_code error;
    fs::rename(temporary_, target_, error);
    if (error) fail(shown_, error.value());
    temporary_.clear();
}

// Closes the file. Throws InputError on failure, because some file systems report a full disk only on closing.
void ReplacedFile::close() {
    const int result = ::close(descriptor_);
    descriptor_ = -1;
    if (result != 0) fail(shown_, errno);
}

void remove_stale_parts(const fs::path& folder) {
    std::error_code ignored;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored)) {
        const std::optional<pid_t> writer = writer_of(entry.path().filename().string());
        if (writer && !is_running(*writer)) fs::remove(entry.path(), ignored);
    }
}

}  // namespace stopline
