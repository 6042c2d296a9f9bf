// Atomic replacement of a file. The content is written to a temporary file in the same folder. The temporary file takes
// the final name only after all of it is on the disk. A run that fails or is killed leaves the old file unchanged.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace stopline {

class ReplacedFile {
public:
    // Opens the temporary file. A symbolic link is followed, so it stays and its target is replaced. A device or a pipe
    // is written directly. This constructor, write() and commit() throw InputError with path and reason.
    explicit ReplacedFile(const std::filesystem::path& file);
    ReplacedFile(const ReplacedFile&) = delete;
    ReplacedFile& operator=(const ReplacedFile&) = delete;
    ReplacedFile(ReplacedFile&&) = delete;
    ReplacedFile& operator=(ReplacedFile&&) = delete;
    ~ReplacedFile();

    void write(std::string_view bytes);
    // Puts the content in place under the final name. Without this call the old file remains.
    void commit();
    std::size_t size() const { return size_; }  // bytes written so far
    const std::filesystem::path& path() const { return shown_; }

private:
    void close();

    std::filesystem::path shown_;      // path as the user wrote it, for messages
    std::filesystem::path target_;     // path after following links
    std::filesystem::path temporary_;  // empty: the target is written directly
    std::size_t size_ = 0;
    int descriptor_ = -1;
};

// Removes the temporary files of killed programs from a folder. Files of running programs remain. Only processes of
// this machine are considered, so do not use it on a folder that several machines write to.
void remove_stale_parts(const std::filesystem::path& folder);

}  // namespace stopline
