#include "record/recording_reader.h"

#include <cerrno>
#include <system_error>

#include <fmt/format.h>

#include "base/input_error.h"
#include "record/bytes.h"
#include "record/compression.h"
#include "record/recording_format.h"

namespace stopline {

RecordingReader::RecordingReader(const std::filesystem::path& file) : path_(file) {
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) fail(std::generic_category().message(EISDIR));
    stream_.open(file, std::ios::binary);
    if (!stream_) fail(fmt::format("cannot read: {}", std::generic_category().message(errno)));
    try {
        check_begin();
        std::string tag;
        header_ = read_section(tag);
        if (tag != kHeadTag) throw InputError("its head is missing");
        run_ = parse_recording_header(header_);
    } catch (const InputError& error) {
        fail(fmt::format("not a recording that can be read: {}", error.what()));
    }
}

void RecordingReader::fail(const std::string& what) const {
    throw InputError(fmt::format("{}: {}", path_.string(), what));
}

void RecordingReader::check_begin() {
    std::string magic(kRecordingMagic.size(), '\0');
    stream_.read(magic.data(), static_cast<std::streamsize>(magic.size()));
    if (magic != kRecordingMagic) throw InputError("it was not written by stopline-run --record");
    const std::string begin = read(4);
    ByteReader reader(begin);
    const auto version = reader.number<std::uint16_t>();
    if (reader.number<std::uint16_t>() != kByteOrderMark) throw InputError("its bytes are in another order");
    if (version != kRecordingVersion) {
        throw InputError(fmt::format("its format is version {}, this program reads version {}: record it again",
                                     version, kRecordingVersion));
    }
}

std::string RecordingReader::read(std::size_t size) {
    std::string bytes(size, '\0');
    stream_.read(bytes.data(), static_cast<std::streamsize>(size));
    if (static_cast<std::size_t>(stream_.gcount()) != size) throw InputError("it ends too early");
    return bytes;
}

std::string RecordingReader::read_section(std::string& tag) {
    const std::string begin = read(12);
    ByteReader reader(begin);
    tag = reader.take(4);
    const auto stored = reader.number<std::uint32_t>();
    const auto raw = reader.number<std::uint32_t>();
    if ((tag != kHeadTag && tag != kFramesTag && tag != kEndTag) || stored > kMostSectionBytes ||
        raw > kMostSectionBytes) {
        throw InputError("it is damaged");
    }
    return unpacked(read(stored), raw);
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
            throw InputError("its sections are out of order");
        }
        frames_ += section.frames;
        section.bytes = bytes.substr(bytes.size() - reader.left());
        return true;
    } catch (const InputError& error) {
        fail(fmt::format("damaged after {} frames: {}", frames_, error.what()));
    }
}

void RecordingReader::check_end(const std::string& bytes) {
    ByteReader reader(bytes);
    if (static_cast<std::int64_t>(reader.number<std::uint64_t>()) != frames_) throw InputError("frames are missing");
    if (stream_.peek() != std::ifstream::traits_type::eof()) throw InputError("something follows its end");
}

}  // namespace stopline
