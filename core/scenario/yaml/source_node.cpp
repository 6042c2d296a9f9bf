#include "scenario/yaml/source_node.h"

#include <utility>

namespace stopline {

std::string to_string(const Place& place) {
    if (!place.source) return "input";
    if (!place.source->has_lines) return place.source->label;
    return place.source->label + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
}

SourceNode* SourceNode::find(std::string_view key) {
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (keys[i].text == key) return &items[i];
    }
    return nullptr;
}

const SourceNode* SourceNode::find(std::string_view key) const {
    for (std::size_t i = 0; i < keys.size(); ++i) {
        if (keys[i].text == key) return &items[i];
    }
    return nullptr;
}

SourceNode& SourceNode::add(Key key, SourceNode value) {
    keys.push_back(std::move(key));
    items.push_back(std::move(value));
    return items.back();
}

}  // namespace stopline
