// YAML text to a tree of nodes, within limits that no honest file reaches, so that no file can exhaust memory, stack or
// patience: size, nesting, number of nodes with aliases written out (the "billion laughs"). Also refused: duplicate keys,
// several documents, tags, keys that are not plain text, and bytes that are not UTF-8 text.
//
// The event interface of yaml-cpp is used and not its Node: the limits then hold while reading, aliases are copied
// instead of shared (a cycle cannot arise), and every node knows its line and column.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "base/input_error.h"
#include "scenario/source_node.h"

namespace stopline {

inline constexpr std::uintmax_t kYamlBytesMax = 4u << 20u;
inline constexpr std::size_t kYamlDepthMax = 32;
inline constexpr std::size_t kYamlNodesMax = 200'000;

// The text is "place: message".
class YamlError : public InputError {
public:
    YamlError(const Place& place, const std::string& message)
        : InputError(to_string(place) + ": " + message), message_(message) {}
    const std::string& message() const { return message_; }

private:
    std::string message_;
};

// Throws YamlError at the first error.
SourceNode parse_yaml(std::string_view text, const std::shared_ptr<const Source>& source);
// Throws InputError, also if the file cannot be read.
SourceNode read_yaml_file(const std::filesystem::path& file);

}  // namespace stopline
