#include "record/recording/compression.h"

#include <new>
#include <stdexcept>

#include <zstd.h>

#include "base/input_error.h"

namespace stopline {

namespace {

constexpr int kFastLevel = 1;

}  // namespace

struct Compressor::Context {
    ZSTD_CCtx* zstd = ZSTD_createCCtx();

    Context() {
        if (zstd == nullptr) throw std::bad_alloc();
    }
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
    Context(Context&&) = delete;
    Context& operator=(Context&&) = delete;
    ~Context() { ZSTD_freeCCtx(zstd); }
};

Compressor::Compressor() : context_(std::make_unique<Context>()) {
    ZSTD_CCtx_setParameter(context_->zstd, ZSTD_c_compressionLevel, kFastLevel);
    ZSTD_CCtx_setParameter(context_->zstd, ZSTD_c_checksumFlag, 1);
}

Compressor::~Compressor() = default;

std::string_view Compressor::compress(std::string_view bytes) {
    buffer_.resize(ZSTD_compressBound(bytes.size()));
    const std::size_t size = ZSTD_compress2(context_->zstd, buffer_.data(), buffer_.size(), bytes.data(), bytes.size());
    if (ZSTD_isError(size) != 0U) throw std::runtime_error(ZSTD_getErrorName(size));
    return {buffer_.data(), size};
}

std::string decompress(std::string_view bytes, std::size_t size) {
    std::string raw(size, '\0');
    const std::size_t count = ZSTD_decompress(raw.data(), raw.size(), bytes.data(), bytes.size());
    if (ZSTD_isError(count) != 0U || count != size) throw InputError("the checksum or the size of a section is wrong");
    return raw;
}

}  // namespace stopline
