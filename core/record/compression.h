// Zstandard, with a checksum in every frame.
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

    // Valid until the next call.
    std::string_view packed(std::string_view bytes);

private:
    struct Context;
    std::unique_ptr<Context> context_;
    std::string buffer_;
};

// Throws InputError where the bytes are damaged or do not unpack to that size.
std::string unpacked(std::string_view bytes, std::size_t size);

}  // namespace stopline
