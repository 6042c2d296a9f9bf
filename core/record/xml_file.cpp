#include "record/xml_file.h"

#include "base/io/escape.h"

namespace stopline {

std::string sumo_lane_name(const Lane& lane) {
    const bool is_sumo_name = lane.origin < 0 || lane.name.front() == ':';
    return escape_xml(is_sumo_name ? lane.name : ":" + lane.name + "_0");
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
