// Writer for XML files in SUMO's formats. It writes the file in blocks, so a large file does not need much memory.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "network/lane_graph.h"
#include "record/streamed_file.h"

namespace stopline {

// Returns the name of a lane in SUMO's style, escaped for XML: the name of the edge, '_' and the index of the lane. The
// name of a connection begins with a colon.
std::string sumo_lane_name(const Lane& lane);

class XmlFile {
public:
    // Begins the file with the XML declaration and the root element. `schema` is the file name of SUMO's schema. A file
    // whose name ends with ".gz" is compressed.
    XmlFile(const std::filesystem::path& file, std::string root, std::string_view schema);

    // Appends formatted text. The caller escapes attribute values with escape_xml().
    template <class... Arguments>
    void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Arguments>(arguments)...);
        if (text_.size() > kBlockBytes) flush();
    }
    // Closes the root element and completes the file, which replaces an older file of the same name. Throws InputError
    // if the file cannot be written.
    void finish();
    const std::filesystem::path& path() const { return file_.path(); }

private:
    static constexpr std::size_t kBlockBytes = 1U << 20U;
    void flush();

    StreamedFile file_;
    std::string root_;
    std::string text_;
};

}  // namespace stopline
