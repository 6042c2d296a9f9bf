// A file that is whole or not there: what is written goes beside its place under another name and takes the place only once all
// of it is on the disk. A run that fails, is interrupted or is killed leaves what was there before.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace stopline {

class ReplacedFile {
public:
    // Through links, so that they stay. What is there but not a regular file (a device, a pipe) is written to, not replaced.
    // This and all below throw InputError with path and reason.
    explicit ReplacedFile(const std::filesystem::path& file);
    ReplacedFile(const ReplacedFile&) = delete;
    ReplacedFile& operator=(const ReplacedFile&) = delete;
    ReplacedFile(ReplacedFile&&) = delete;
    ReplacedFile& operator=(ReplacedFile&&) = delete;
    ~ReplacedFile();

    void write(std::string_view bytes);
    // Nothing is seen under the file's name before this.
    void commit();
    std::size_t size() const { return size_; }  // bytes written so far
    const std::filesystem::path& path() const { return shown_; }

private:
    void close();

    std::filesystem::path shown_;   // as the user named it
    std::filesystem::path target_;  // where that leads to
    std::filesystem::path beside_;  // empty: written in place
    std::size_t size_ = 0;
    int descriptor_ = -1;
};

// Removes from a folder what programs that were killed had not yet put into its place; what others are writing just now stays.
// Whether they run is asked of this machine: not for folders that several machines write into.
void remove_left_parts(const std::filesystem::path& folder);

}  // namespace stopline
