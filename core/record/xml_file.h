// XML as SUMO writes it, in pieces: a file of any length takes no memory.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "base/replaced_file.h"
#include "network/lane_graph.h"

namespace stopline {

// As the value of an attribute.
std::string xml_escaped(std::string_view text);

// The lane's name as SUMO has it: edge and index, with a colon in front inside an intersection.
std::string sumo_lane_name(const Lane& lane);

class XmlFile {
public:
    // Writes the head, and the root element with the schema that SUMO's tools check it against.
    XmlFile(const std::filesystem::path& file, std::string root, std::string_view schema);

    template <class... Arguments>
    void add(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
        fmt::format_to(std::back_inserter(text_), format, std::forward<Arguments>(arguments)...);
        if (text_.size() > kTogether) flush();
    }
    void finish();
    const std::filesystem::path& path() const { return file_.path(); }

private:
    static constexpr std::size_t kTogether = 1U << 20U;
    void flush();

    ReplacedFile file_;
    std::string root_;
    std::string text_;
};

}  // namespace stopline
