// A tree of uninterpreted text with positions, made from a YAML file, an override or a data file. One reader
// (read_fields.h) checks all of them, and every message can name a place.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace stopline {

// The origin of a text: a file, or an override on the command line.
struct Source {
    std::string label;                // name in messages
    std::filesystem::path directory;  // relative paths in the text start here
    bool has_lines = true;            // false for an override: messages show the label without line and column
};

struct Place {
    std::shared_ptr<const Source> source;
    int line = 1;
    int column = 1;
};

// Returns "file:line:column", or the label alone for a source without lines.
std::string to_string(const Place& place);

struct SourceNode {
    enum class Kind {
        empty,   // a key without a value, or null
        scalar,  // `text`
        list,    // `items`
        map,     // `items`; keys[i] is the key of items[i]
        broken   // its error is already reported: skip the node
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

    // Returns the value of a key in a map, or null.
    SourceNode* find(std::string_view key);
    const SourceNode* find(std::string_view key) const;
    // Appends an entry to a map and returns its value.
    SourceNode& add(Key key, SourceNode value);
};

}  // namespace stopline
