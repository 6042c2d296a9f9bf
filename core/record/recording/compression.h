// Zstandard compression with checksums.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

namespace stopline {

class Compressor {
public:
    Compressor();
    Compressor(const Compressor&) = delete;
    Compressor& operator=(const Compressor&) = delete;
    Compressor(Compressor&&) = delete;
    Compressor& operator=(Compressor&&) = delete;
    ~Compressor();

    // Compresses the bytes. The result is a view that is valid until the next call.
    std::string_view compress(std::string_view bytes);

private:
    struct Context;
    std::unique_ptr<Context> context_;
    std::string buffer_;
};

// Returns the decompressed bytes. Throws InputError if the bytes are damaged or do not decompress to `size` bytes.
std::string decompress(std::string_view bytes, std::size_t size);

}  // namespace stopline
