// A result file that is written piece by piece. A file whose name ends with ".gz" is compressed with gzip,
// and one that ends with ".zst" with Zstandard.
#pragma once

#include <filesystem>
#include <memory>
#include <string_view>

#include "base/io/replaced_file.h"

namespace stopline {

class StreamedFile {
public:
    // Opens a temporary file. commit() replaces `file` by this temporary file. A device or a pipe is written directly.
    // On failure the constructor, write() and commit() throw InputError.
    explicit StreamedFile(const std::filesystem::path& file);
    StreamedFile(const StreamedFile&) = delete;
    StreamedFile& operator=(const StreamedFile&) = delete;
    StreamedFile(StreamedFile&&) = delete;
    StreamedFile& operator=(StreamedFile&&) = delete;
    ~StreamedFile();

    void write(std::string_view bytes);
    // Completes the file, which replaces an older file of the same name. Without this call the old file remains.
    void commit();
    const std::filesystem::path& path() const { return file_.path(); }

private:
    class Compressor;
    class GzipCompressor;
    class ZstdCompressor;

    ReplacedFile file_;
    std::unique_ptr<Compressor> compressor_;  // null: the file is not compressed
};

// Writes a whole file, compressed if its name ends with ".gz" or ".zst". Throws InputError with path and reason on
// failure.
void write_streamed_file(const std::filesystem::path& file, std::string_view text);

}  // namespace stopline
