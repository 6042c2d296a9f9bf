// Reads YAML text into a tree of nodes. Limits on size, nesting and number of nodes protect memory, stack and run time.
// Each alias counts as a full copy of its anchor, so a "billion laughs" file is refused. The reader also refuses
// duplicate keys, several documents in a file, YAML tags, keys that are lists or maps, control characters, and text
// that is not UTF-8.
//
// The reader uses the event interface of yaml-cpp instead of YAML::Node. It can thus check the limits while it reads,
// and store line and column in every node. It copies the node of an alias, so that the tree has no cycles.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "base/input_error.h"
#include "scenario/yaml/source_node.h"

namespace stopline {

inline constexpr std::uintmax_t kYamlBytesMax = 4u << 20u;
inline constexpr std::size_t kYamlDepthMax = 32;
inline constexpr std::size_t kYamlOpenBracketsMax = 1000;
inline constexpr std::size_t kYamlNodesMax = 200'000;
inline constexpr std::size_t kYamlTextMax = 16u << 20u;  // bytes of all values, with aliases written out

// An error in a YAML text. what() returns "place: message".
class YamlError : public InputError {
public:
    YamlError(const Place& place, const std::string& message)
        : InputError(to_string(place) + ": " + message), message_(message) {}
    const std::string& message() const { return message_; }

private:
    std::string message_;
};

// Parses a YAML text. Throws YamlError at the first error.
SourceNode parse_yaml(std::string_view text, const std::shared_ptr<const Source>& source);
// Returns the end of a message about a missing file: "; did you mean 'grid.yaml'?" if the folder of the file has a YAML
// file with a similar name, else "".
std::string nearest_file_hint(const std::filesystem::path& file);
// Reads and parses a YAML file. Throws InputError if the file cannot be read or is not valid YAML.
SourceNode read_yaml_file(const std::filesystem::path& file);

}  // namespace stopline
