#include "replay/packing.h"

#include <stdexcept>

#include <zlib.h>

namespace stopline {

std::string compress_zlib(std::string_view bytes) {
    constexpr int kLevel = 6;
    uLongf size = compressBound(bytes.size());
    std::string packed(size, '\0');
    auto* const to = reinterpret_cast<Bytef*>(packed.data());
    const auto* const from = reinterpret_cast<const Bytef*>(bytes.data());
    if (compress2(to, &size, from, bytes.size(), kLevel) != Z_OK)
        throw std::runtime_error("zlib cannot compress the recording");
    packed.resize(size);
    return packed;
}

}  // namespace stopline
