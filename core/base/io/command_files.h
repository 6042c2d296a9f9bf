// The files that one command reads and writes. A program collects them before its work begins, so that no output
// overwrites an input or another output.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace stopline {

// Returns the absolute path with symbolic links resolved. Parts of the path that do not exist are kept.
std::filesystem::path resolved_path(const std::filesystem::path& file);

// Two paths are the same file if they are equal after symbolic links are resolved, or if they lead to the same file on
// the disk. Devices and pipes are left out, because several outputs may use them.
class CommandFiles {
public:
    // Adds a file that the command reads. `role` describes it in messages, such as "the scenario". Throws InputError if
    // an output added before is the same file.
    void add_input(const std::filesystem::path& file, const std::string& role);
    // Adds a file that the command writes. `role` is often the option that names it, such as "--record". Throws
    // InputError if an input or an output added before is the same file.
    void add_output(const std::filesystem::path& file, const std::string& role);
    // Adds outputs with these names in a folder.
    void add_outputs(const std::filesystem::path& folder, const std::vector<std::string>& names,
                     const std::string& role);

private:
    struct Entry {
        std::filesystem::path shown;  // path as the user wrote it
        std::string role;
        bool is_output = false;
    };
    using FileId = std::pair<std::uint64_t, std::uint64_t>;  // number of the device, number of the file on it

    void add(const std::filesystem::path& file, const Entry& entry);
    // Returns the entry of the same file; null if there is none.
    const Entry* find(const std::filesystem::path& resolved) const;

    std::vector<Entry> entries_;
    std::map<std::filesystem::path, std::size_t> by_path_;  // resolved path -> index into entries_
    std::map<FileId, std::size_t> by_id_;
};

}  // namespace stopline
