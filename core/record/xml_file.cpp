#include "record/xml_file.h"

namespace stopline {

std::string xml_escaped(std::string_view text) {
    std::string escaped;
    for (const char c : text) {
        switch (c) {
            case '&':
                escaped += "&amp;";
                break;
            case '<':
                escaped += "&lt;";
                break;
            case '>':
                escaped += "&gt;";
                break;
            case '"':
                escaped += "&quot;";
                break;
            case '\n':
                escaped += "&#10;";
                break;
            case '\t':
                escaped += "&#9;";
                break;
            default:
                escaped += static_cast<unsigned char>(c) < ' ' ? '?' : c;  // XML 1.0 has no other control characters
        }
    }
    return escaped;
}

std::string sumo_lane_name(const Lane& lane) {
    const bool is_sumos = lane.origin < 0 || lane.name.front() == ':';
    return xml_escaped(is_sumos ? lane.name : ":" + lane.name + "_0");
}

XmlFile::XmlFile(const std::filesystem::path& file, std::string root, std::string_view schema)
    : file_(file), root_(std::move(root)) {
    add("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<{} xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
        "xsi:noNamespaceSchemaLocation=\"http://sumo.dlr.de/xsd/{}\">\n",
        root_, schema);
}

void XmlFile::flush() {
    file_.write(text_);
    text_.clear();
}

void XmlFile::finish() {
    add("</{}>\n", root_);
    flush();
    file_.commit();
}

}  // namespace stopline
