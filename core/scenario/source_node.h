// A tree of text with positions: what a YAML file says, before anybody asks what it means. Overrides and data files become
// such trees too, so one reader (read_fields.h) checks them all and every message can name its place.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace stopline {

// Where a text comes from: a file, or an override on the command line.
struct Source {
    std::string label;                // as it appears in messages
    std::filesystem::path directory;  // relative paths in it start here
    bool has_lines = true;            // false: its label says enough
};

struct Place {
    std::shared_ptr<const Source> source;
    int line = 1;
    int column = 1;
};

// "file:line:column", or the label alone for a source without lines.
std::string to_string(const Place& place);

struct SourceNode {
    enum class Kind {
        empty,   // a key without a value, or null
        scalar,  // `text`
        list,    // `items`
        map,     // `items`, with the key of items[i] in keys[i]
        broken   // an error in it has been reported already: to be passed over
    };
    struct Key {
        std::string text;
        Place place;
    };

    Kind kind = Kind::empty;
    Place place;
    std::string text;
    std::vector<Key> keys;
    std::vector<SourceNode> items;

    SourceNode* find(std::string_view key);
    const SourceNode* find(std::string_view key) const;
    SourceNode& add(Key key, SourceNode value);  // to a map
};

}  // namespace stopline
