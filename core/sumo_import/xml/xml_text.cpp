#include "sumo_import/xml/xml_text.h"

#include <algorithm>
#include <cstdint>
#include <fstream>

#include <unistd.h>

#include <fmt/format.h>

#define ZLIB_CONST  // the input of zlib is constant
#include <zlib.h>

#include "base/input_error.h"

namespace stopline {

namespace {

std::string size_text(std::size_t bytes) {
    return fmt::format("{:.0f} MB", static_cast<double>(bytes) / static_cast<double>(1U << 20U));
}

// Returns the memory that a file of this size may need.
std::size_t memory_limit(std::size_t file_bytes) {
    return std::min(kXmlMemoryBase + kXmlMemoryFactor * file_bytes, kXmlMemoryMax);
}

[[noreturn]] void throw_too_long(const std::string& name) {
    throw InputError(fmt::format("{}: the text of the file is larger than 2 GiB", name));
}

[[noreturn]] void throw_too_much_memory(const std::string& name, std::size_t file_bytes) {
    throw InputError(
        fmt::format("{}: the file has {} and would need more than {} of memory, because it has too many elements, "
                    "attributes or lines for its size; at most {} plus {} times the size of the file are allowed, and "
                    "at most {} in total",
                    name, size_text(file_bytes), size_text(memory_limit(file_bytes)), size_text(kXmlMemoryBase),
                    kXmlMemoryFactor, size_text(kXmlMemoryMax)));
}

std::string read_bytes(const std::filesystem::path& file, const std::string& name) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (!error && size >= kXmlBytesMax) throw_too_long(name);
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw InputError(name + ": the file cannot be opened");
    std::string bytes(static_cast<std::size_t>(error ? 0 : size), '\0');
    stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    if (!stream) throw InputError(name + ": the file cannot be read to its end");
    return bytes;
}

// Unpacks gzip data, which are one or more members, one after the other.
class Unpacker {
public:
    Unpacker(std::string_view packed, const std::string& name) : packed_(packed), name_(name) {
        constexpr int kGzipWindow = 15 + 16;  // zlib: the largest window, with the header of gzip
        if (inflateInit2(&stream_, kGzipWindow) != Z_OK) throw std::bad_alloc();
        stream_.next_in = reinterpret_cast<const Bytef*>(packed.data());
        stream_.avail_in = static_cast<uInt>(packed.size());
    }
    Unpacker(const Unpacker&) = delete;
    Unpacker& operator=(const Unpacker&) = delete;
    Unpacker(Unpacker&&) = delete;
    Unpacker& operator=(Unpacker&&) = delete;
    ~Unpacker() { inflateEnd(&stream_); }

    std::string unpack() {
        while (!is_at_end()) {
            if (!is_gzip(rest())) throw_trailing_bytes();
            inflateReset(&stream_);
            unpack_member();
        }
        return std::move(text_);
    }

    static bool is_gzip(std::string_view bytes) { return bytes.starts_with("\x1f\x8b"); }

private:
    std::string_view rest() const { return packed_.substr(packed_.size() - stream_.avail_in); }

    // Some programs fill the last block of a gzip file with zeros.
    bool is_at_end() const { return rest().find_first_not_of('\0') == std::string_view::npos; }

    void unpack_member() {
        for (int state = Z_OK; state != Z_STREAM_END;) {
            const std::size_t before = text_.size();
            stream_.next_out = reinterpret_cast<Bytef*>(chunk_.data());
            stream_.avail_out = static_cast<uInt>(chunk_.size());
            state = inflate(&stream_, Z_NO_FLUSH);
            text_.append(chunk_, 0, chunk_.size() - stream_.avail_out);
            if (state == Z_MEM_ERROR) throw std::bad_alloc();
            if (state != Z_OK && state != Z_STREAM_END) throw_damaged();
            if (text_.size() >= kXmlBytesMax) throw_too_long(name_);
            memory_ += xml_memory(std::string_view(text_).substr(before));
            if (memory_ > memory_limit(packed_.size())) throw_too_much_memory(name_, packed_.size());
        }
    }

    [[noreturn]] void throw_damaged() const {
        throw InputError(fmt::format("{}:{}: the gzip data are damaged or end too early here", name_,
                                     std::count(text_.begin(), text_.end(), '\n') + 1));
    }

    [[noreturn]] void throw_trailing_bytes() const {
        throw InputError(fmt::format("{}: {} bytes follow the end of the gzip data, from byte {} on; remove them",
                                     name_, stream_.avail_in, packed_.size() - stream_.avail_in));
    }

    std::string_view packed_;
    const std::string& name_;
    std::string chunk_ = std::string(std::size_t{1} << 18U, '\0');  // unpacked bytes of one call of zlib
    z_stream stream_{};
    std::string text_;
    std::size_t memory_ = 0;
};

}  // namespace

std::size_t xml_memory(std::string_view text) {
    // An element takes a node of pugixml, and its text another one. The line breaks are listed for messages.
    constexpr std::size_t kElement = 128;
    constexpr std::size_t kAttribute = 40;
    constexpr std::size_t kLine = 4;
    std::size_t memory = text.size();
    for (const char c : text) memory += c == '<' ? kElement : c == '=' ? kAttribute : c == '\n' ? kLine : 0;
    return memory;
}

std::string read_xml_text(const std::filesystem::path& file, const std::string& name) {
    if (const std::string problem = sumo_file_problem(file); !problem.empty()) throw InputError(name + ": " + problem);
    std::string bytes = read_bytes(file, name);
    if (Unpacker::is_gzip(bytes)) return Unpacker(bytes, name).unpack();
    if (xml_memory(bytes) > memory_limit(bytes.size())) throw_too_much_memory(name, bytes.size());
    return bytes;
}

std::string sumo_file_problem(const std::filesystem::path& file) {
    std::error_code error;
    const std::filesystem::file_status status = std::filesystem::status(file, error);
    if (status.type() == std::filesystem::file_type::not_found) return "there is no such file";
    if (std::filesystem::is_directory(status)) return "this is a folder; a file is needed";
    if (!std::filesystem::is_regular_file(status)) return "this is a device or a pipe; a regular file is needed";
    return ::access(file.c_str(), R_OK) == 0 ? "" : "the file cannot be opened; check its permissions";
}

}  // namespace stopline
