// A tree of texts with their positions, made from a YAML file or from an override on the command line. read_fields.h
// converts the texts to numbers and checks them. Each message can name the file, the line and the column.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace stopline {

// The origin of a text: a file, or an override on the command line.
struct Source {
    std::string label;                // name of the file or the override in messages
    std::filesystem::path directory;  // folder at which relative paths in the text start
    bool has_lines = true;            // false for an override: messages show the label without line and column
};

// A position in a source.
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
        scalar,  // a single value, in `text`
        list,    // its entries are in `items`
        map,     // its values are in `items`; keys[i] is the key of items[i]
        broken   // unusable; the error has been reported, so later code skips the node
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

    // Returns the value of a key in a map; null if the map does not have the key.
    SourceNode* find(std::string_view key);
    const SourceNode* find(std::string_view key) const;
    // Appends an entry to a map. Returns a reference to the appended value.
    SourceNode& add(Key key, SourceNode value);
};

}  // namespace stopline
