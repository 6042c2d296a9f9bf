#include "base/io/replaced_file.h"

#include <fcntl.h>
#include <signal.h>  // declares the POSIX function kill()
#include <unistd.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "base/input_error.h"

namespace stopline {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kTemporarySuffix = ".part";
// SQLite adds these to the name of a database for its own temporary files.
constexpr std::array<std::string_view, 3> kDatabaseSuffixes{"-wal", "-journal", "-shm"};

[[noreturn]] void fail(const fs::path& path, int error) {
    throw InputError(fmt::format("{}: cannot write: {}", path.string(), std::generic_category().message(error)));
}

// Returns a text that stands for this machine in the names of temporary files. Machines and containers can have the
// same host name, so the text also depends on the start of the operating system and on the container.
std::string machine_text() {
    std::array<char, 256> name{};
    static_cast<void>(::gethostname(name.data(), name.size() - 1));
    std::string machine(name.data());
    std::string start;
    std::getline(std::ifstream("/proc/sys/kernel/random/boot_id"), start);
    std::error_code ignored;
    machine += start + fs::read_symlink("/proc/self/ns/pid", ignored).string();
    std::uint32_t hash = 0x811c9dc5U;  // FNV-1a, 32 bits
    for (const char c : machine) hash = (hash ^ static_cast<unsigned char>(c)) * 0x01000193U;
    return fmt::format("{:08x}", hash);
}

// Removes the ending of `name` and the '.' before it, and returns this ending. Returns "" if `name` has no '.'.
std::string take_ending(std::string& name) {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string::npos) return {};
    std::string ending = name.substr(dot + 1);
    name.resize(dot);
    return ending;
}

// Returns the id of the process of this machine that wrote the temporary file `name`, or nothing if `name` is no
// temporary file of this machine.
std::optional<pid_t> writer_of(std::string name) {
    for (const std::string_view suffix : kDatabaseSuffixes) {
        if (name.ends_with(std::string(kTemporarySuffix) + std::string(suffix))) {
            name.resize(name.size() - suffix.size());
        }
    }
    if (!name.starts_with('.') || !name.ends_with(kTemporarySuffix)) return std::nullopt;
    name.resize(name.size() - kTemporarySuffix.size());
    const std::string process = take_ending(name);
    const std::string machine = take_ending(name);
    if (name.size() < 2 || machine != machine_text()) return std::nullopt;
    const char* const end = process.data() + process.size();
    pid_t writer = 0;
    const auto [stop, error] = std::from_chars(process.data(), end, writer);
    if (error != std::errc() || stop != end || writer <= 0) return std::nullopt;
    return writer;
}

bool is_running(pid_t process) { return ::kill(process, 0) == 0 || errno != ESRCH; }

}  // namespace

fs::path temporary_path(const fs::path& target) {
    return target.parent_path() /
           fmt::format(".{}.{}.{}{}", target.filename().string(), machine_text(), ::getpid(), kTemporarySuffix);
}

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
        if (writer && !is_running(*writer)) fs::remove_all(entry.path(), ignored);
    }
}

}  // namespace stopline
