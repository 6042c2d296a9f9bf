// Atomic replacement of a file. The content is written to a temporary file in the same folder. The temporary file gets
// the final name only after its whole content is on the disk. A program that fails or is killed leaves the old file
// unchanged.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace stopline {

class ReplacedFile {
public:
    // Opens the temporary file. If `file` is a symbolic link, the link stays and its target is replaced. A device or a
    // pipe is written directly. On failure this constructor, write() and commit() throw InputError with path and
    // reason.
    explicit ReplacedFile(const std::filesystem::path& file);
    ReplacedFile(const ReplacedFile&) = delete;
    ReplacedFile& operator=(const ReplacedFile&) = delete;
    ReplacedFile(ReplacedFile&&) = delete;
    ReplacedFile& operator=(ReplacedFile&&) = delete;
    ~ReplacedFile();

    void write(std::string_view bytes);
    // Replaces the old file by the new content. Without this call the old file remains.
    void commit();
    std::size_t size() const { return size_; }  // bytes written so far
    const std::filesystem::path& path() const { return shown_; }

private:
    void close();

    std::filesystem::path shown_;      // path as the user wrote it, for error messages
    std::filesystem::path target_;     // path of the file to replace, with symbolic links resolved
    std::filesystem::path temporary_;  // path of the temporary file; empty if the target is written directly
    std::size_t size_ = 0;
    int descriptor_ = -1;
};

// Returns the path .NAME.MACHINE.PROCESS.part of the temporary file or folder for a target, in the same folder. Several
// programs on several machines can write the same target at the same time.
std::filesystem::path temporary_path(const std::filesystem::path& target);

// Removes the temporary files and folders that killed programs of this machine left in a folder. Those of running
// programs and of other machines remain.
void remove_stale_parts(const std::filesystem::path& folder);

}  // namespace stopline
