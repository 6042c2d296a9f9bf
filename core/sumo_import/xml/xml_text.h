// Reads the text of an XML file, plain or gzipped, and checks limits on its size before memory is allocated for it.
//
// A short gzip file can unpack to a very long text, and a text of many small elements needs far more memory than its
// length. Therefore the memory that the parsed text would need is limited in proportion to the size of the file. Files
// that SUMO writes stay far below the limit: gzip makes them 7 to 30 times as small, and parsing takes two to six times
// the length of their text.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace stopline {

inline constexpr std::size_t kXmlBytesMax = std::size_t{1} << 31U;  // of the unpacked text
// A file may need this memory, plus a multiple of its size on disk, but not more than the maximum.
inline constexpr std::size_t kXmlMemoryBase = std::size_t{64} << 20U;
inline constexpr std::size_t kXmlMemoryFactor = 500;
inline constexpr std::size_t kXmlMemoryMax = std::size_t{8} << 30U;

// Returns the text of the file, unpacked if it is gzipped. `name` is the name of the file in messages. Throws
// InputError if the file cannot be read, exceeds a limit, or has bytes after the end of its gzip data.
std::string read_xml_text(const std::filesystem::path& file, const std::string& name);

// Returns an upper bound of the memory that the text and its parsed elements take, in bytes.
std::size_t xml_memory(std::string_view text);

// Returns the reason why the file cannot be read, or "" if it is a readable regular file.
std::string sumo_file_problem(const std::filesystem::path& file);

}  // namespace stopline
