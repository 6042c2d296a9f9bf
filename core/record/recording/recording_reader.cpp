#include "record/recording/recording_reader.h"

#include <cerrno>
#include <limits>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/input_error.h"
#include "record/recording/bytes.h"
#include "record/recording/compression.h"
#include "record/recording/recording_format.h"

namespace stopline {

RecordingReader::RecordingReader(const std::filesystem::path& file) : path_(file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) fail(std::generic_category().message(EISDIR));
    stream_.open(file, std::ios::binary);
    if (!stream_) fail(fmt::format("the file cannot be read: {}", std::generic_category().message(errno)));
    remaining_ = std::filesystem::file_size(file, ignored);
    if (ignored) remaining_ = std::numeric_limits<std::uintmax_t>::max();
    try {
        check_begin();
        std::string tag;
        header_ = read_section(tag);
        if (tag != kHeadTag) throw InputError("the header is missing");
        run_ = parse_recording_header(header_);
    } catch (const InputError& error) {
        fail(fmt::format("the file is not a readable recording: {}", error.what()));
    }
}

void RecordingReader::fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", path_.string(), what));
}

void RecordingReader::check_begin() {
    if (remaining_ < kRecordingMagic.size() || read(kRecordingMagic.size()) != kRecordingMagic)
        throw InputError("the file was not written by stopline-run --record");
    const std::string begin = read(4);
    ByteReader reader(begin);
    const auto version = reader.number<std::uint16_t>();
    if (reader.number<std::uint16_t>() != kByteOrderMark) throw InputError("the byte order is wrong");
    if (version != kRecordingVersion) {
        throw InputError(
            fmt::format("the file has format version {}, but this program reads version {}; record the run again",
                        version, kRecordingVersion));
    }
}

std::string RecordingReader::read(std::size_t size) {
    if (size > remaining_) throw InputError("the file ends too early");
    remaining_ -= size;
    std::string bytes(size, '\0');
    stream_.read(bytes.data(), static_cast<std::streamsize>(size));
    if (static_cast<std::size_t>(stream_.gcount()) != size) throw InputError("the file ends too early");
    return bytes;
}

std::string RecordingReader::read_section(std::string& tag) {
    const std::string begin = read(12);
    ByteReader reader(begin);
    tag = reader.take(4);
    const auto stored = reader.number<std::uint32_t>();
    const auto unpacked_size = reader.number<std::uint32_t>();
    if ((tag != kHeadTag && tag != kFramesTag && tag != kEndTag) || stored > kMaxSectionBytes ||
        unpacked_size > kMaxSectionBytes) {
        throw InputError("a section header is damaged");
    }
    if (unpacked_size > kAlwaysUnpackedBytes + kMaxSectionRatio * std::size_t{stored}) {
        throw InputError(
            fmt::format("a section unpacks from {} to {} bytes; at most {} plus {} times its size is allowed", stored,
                        unpacked_size, kAlwaysUnpackedBytes, kMaxSectionRatio));
    }
    return decompress(read(stored), unpacked_size);
}

bool RecordingReader::next(RecordedSection& section) {
    try {
        std::string tag;
        std::string bytes = read_section(tag);
        if (tag == kEndTag) {
            check_end(bytes);
            return false;
        }
        ByteReader reader(bytes);
        section.first_frame = reader.number<std::uint32_t>();
        section.frames = reader.number<std::uint16_t>();
        if (tag != kFramesTag || section.first_frame != frames_ || section.frames == 0) {
            throw InputError("the sections are out of order");
        }
        frames_ += section.frames;
        bytes.erase(0, bytes.size() - reader.remaining());
        section.bytes = std::move(bytes);
        return true;
    } catch (const InputError& error) {
        fail(fmt::format("the recording is damaged after {} frames: {}", frames_, error.what()));
    }
}

void RecordingReader::check_end(const std::string& bytes) {
    ByteReader reader(bytes);
    if (static_cast<std::int64_t>(reader.number<std::uint64_t>()) != frames_) throw InputError("frames are missing");
    if (stream_.peek() != std::ifstream::traits_type::eof()) throw InputError("bytes follow the end of the recording");
}

}  // namespace stopline
