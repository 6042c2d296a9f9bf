#include "fuzz/packing.h"

#include <algorithm>

#define ZLIB_CONST  // the input of zlib is constant
#include <zlib.h>

#include "base/input_error.h"
#include "record/recording/bytes.h"
#include "record/recording/compression.h"
#include "record/recording/recording_format.h"

namespace stopline::fuzz {

namespace {

constexpr std::size_t kMaxUnpacked = std::size_t{1} << 20U;
constexpr int kGzipWindow = 15 + 16;  // zlib: the largest window, with the header of gzip

z_stream stream_from(std::string_view bytes) {
    z_stream stream{};
    stream.next_in = reinterpret_cast<const Bytef*>(bytes.data());
    stream.avail_in = static_cast<uInt>(bytes.size());
    return stream;
}

}  // namespace

bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

std::string unpack_gzip(std::string_view bytes) {
    z_stream stream = stream_from(bytes);
    std::string text(kMaxUnpacked, '\0');
    stream.next_out = reinterpret_cast<Bytef*>(text.data());
    stream.avail_out = static_cast<uInt>(text.size());
    if (inflateInit2(&stream, kGzipWindow) != Z_OK) return {};
    inflate(&stream, Z_FINISH);
    text.resize(stream.total_out);
    inflateEnd(&stream);
    return text;
}

std::string pack_gzip(std::string_view text) {
    constexpr int kMemoryLevel = 8;
    z_stream stream = stream_from(text);
    const int result = deflateInit2(&stream, Z_BEST_SPEED, Z_DEFLATED, kGzipWindow, kMemoryLevel, Z_DEFAULT_STRATEGY);
    if (result != Z_OK) return {};
    std::string bytes(deflateBound(&stream, static_cast<uLong>(text.size())), '\0');
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data());
    stream.avail_out = static_cast<uInt>(bytes.size());
    deflate(&stream, Z_FINISH);
    bytes.resize(stream.total_out);
    deflateEnd(&stream);
    return bytes;
}

std::vector<Section> sections_of(std::string_view recording) {
    std::vector<Section> sections;
    try {
        ByteReader reader(recording);
        reader.take(kRecordingMagic.size() + 4);
        while (reader.remaining() > 0) {
            const std::string tag(reader.take(4));
            const auto stored = reader.number<std::uint32_t>();
            const auto unpacked = reader.number<std::uint32_t>();
            if (unpacked > kMaxUnpacked) break;
            sections.push_back({tag, decompress(reader.take(stored), unpacked)});
        }
    } catch (const InputError&) {
        return sections;
    }
    return sections;
}

std::string pack_recording(const std::vector<Section>& sections) {
    Compressor compressor;
    std::string bytes(kRecordingMagic);
    put_number(bytes, kRecordingVersion);
    put_number(bytes, kByteOrderMark);
    for (const Section& section : sections) {
        const std::string_view packed = compressor.compress(section.bytes);
        bytes += section.tag;
        put_number(bytes, static_cast<std::uint32_t>(packed.size()));
        put_number(bytes, static_cast<std::uint32_t>(section.bytes.size()));
        bytes += packed;
    }
    return bytes;
}

}  // namespace stopline::fuzz
