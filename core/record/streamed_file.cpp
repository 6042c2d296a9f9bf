#include "record/streamed_file.h"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <zlib.h>

#include "base/input_error.h"

namespace stopline {

// The gzip header contains neither a time nor a file name, so equal runs give equal bytes.
class StreamedFile::Compressor {
public:
    explicit Compressor(ReplacedFile& file) : file_(file), buffer_(kBufferBytes) {
        constexpr int kGzipWindow = 15 + 16;  // largest window, and a gzip header instead of a zlib header
        constexpr int kMemoryLevel = 8;       // default of zlib
        const int code = deflateInit2(&stream_, kLevel, Z_DEFLATED, kGzipWindow, kMemoryLevel, Z_DEFAULT_STRATEGY);
        if (code != Z_OK) throw InputError(fmt::format("{}: cannot start zlib: code {}", file.path().string(), code));
    }
    Compressor(const Compressor&) = delete;
    Compressor& operator=(const Compressor&) = delete;
    Compressor(Compressor&&) = delete;
    Compressor& operator=(Compressor&&) = delete;
    ~Compressor() { deflateEnd(&stream_); }

    void write(std::string_view bytes) {
        while (!bytes.empty()) {
            // The input is copied in parts, because zlib needs a buffer that is not const and counts its bytes in 32
            // bits.
            constexpr std::size_t kMaxBytes = std::numeric_limits<uInt>::max();
            const std::size_t count = std::min(bytes.size(), kMaxBytes);
            input_.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(count));
            bytes.remove_prefix(count);
            stream_.next_in = input_.data();
            stream_.avail_in = static_cast<uInt>(count);
            drain(Z_NO_FLUSH);
        }
    }
    void finish() { drain(Z_FINISH); }

private:
    static constexpr int kLevel = 6;  // default of gzip
    static constexpr std::size_t kBufferBytes = 1U << 18U;

    // Compresses the input and writes the output that zlib has ready. With Z_FINISH, also writes the rest of the output
    // and the end of the gzip data.
    void drain(int flush) {
        do {
            stream_.next_out = buffer_.data();
            stream_.avail_out = static_cast<uInt>(buffer_.size());
            deflate(&stream_, flush);
            text_.assign(buffer_.begin(), buffer_.end() - static_cast<std::ptrdiff_t>(stream_.avail_out));
            file_.write(text_);
        } while (stream_.avail_out == 0);
    }

    ReplacedFile& file_;
    z_stream stream_{};
    std::vector<Bytef> input_;
    std::vector<Bytef> buffer_;
    std::string text_;
};

StreamedFile::StreamedFile(const std::filesystem::path& file) : file_(file) {
    if (file.extension() == ".gz") compressor_ = std::make_unique<Compressor>(file_);
}

StreamedFile::~StreamedFile() = default;

void StreamedFile::write(std::string_view bytes) {
    if (compressor_) return compressor_->write(bytes);
    file_.write(bytes);
}

void StreamedFile::commit() {
    if (compressor_) compressor_->finish();
    file_.commit();
}

void write_streamed_file(const std::filesystem::path& file, std::string_view text) {
    StreamedFile streamed(file);
    streamed.write(text);
    streamed.commit();
}

}  // namespace stopline
