#include "base/io/command_files.h"

#include <sys/stat.h>

#include <optional>
#include <system_error>

#include <fmt/format.h>

#include "base/input_error.h"

namespace stopline {

namespace {

namespace fs = std::filesystem;

// Returns the numbers that identify an existing file on this machine.
std::optional<std::pair<std::uint64_t, std::uint64_t>> file_id(const fs::path& file) {
    struct stat status {};
    if (::stat(file.c_str(), &status) != 0) return std::nullopt;
    return std::pair<std::uint64_t, std::uint64_t>(status.st_dev, status.st_ino);
}

bool is_device_or_pipe(const fs::path& file) {
    std::error_code ignored;
    const fs::file_status status = fs::status(file, ignored);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

}  // namespace

fs::path resolved_path(const fs::path& file) {
    std::error_code error;
    fs::path resolved = fs::weakly_canonical(fs::absolute(file, error), error);
    return error ? fs::absolute(file).lexically_normal() : resolved;
}

const CommandFiles::Entry* CommandFiles::find(const fs::path& resolved) const {
    if (const auto same = by_path_.find(resolved); same != by_path_.end()) return &entries_[same->second];
    const auto id = file_id(resolved);
    const auto same = id ? by_id_.find(*id) : by_id_.end();
    return same == by_id_.end() ? nullptr : &entries_[same->second];
}

void CommandFiles::add(const fs::path& file, const Entry& entry) {
    if (file.empty() || is_device_or_pipe(file)) return;
    const fs::path resolved = resolved_path(file);
    const Entry* const other = find(resolved);
    if (other != nullptr && (entry.is_output || other->is_output)) {
        const Entry& output = entry.is_output ? entry : *other;
        const Entry& partner = entry.is_output ? *other : entry;
        throw InputError(fmt::format("'{}' ({}) would overwrite '{}' ({}); give another file", output.shown.string(),
                                     output.role, partner.shown.string(), partner.role));
    }
    entries_.push_back(entry);
    by_path_.try_emplace(resolved, entries_.size() - 1);
    if (const auto id = file_id(resolved)) by_id_.try_emplace(*id, entries_.size() - 1);
}

void CommandFiles::add_input(const fs::path& file, const std::string& role) { add(file, {file, role, false}); }

void CommandFiles::add_output(const fs::path& file, const std::string& role) { add(file, {file, role, true}); }

void CommandFiles::add_outputs(const fs::path& folder, const std::vector<std::string>& names, const std::string& role) {
    for (const std::string& name : names) add_output(folder / name, role);
}

}  // namespace stopline
