// Reads YAML text into a tree of nodes. Limits on size, nesting and number of nodes protect memory, stack and run time.
// Aliases count as written out, so a "billion laughs" file is refused. The reader also refuses duplicate keys, several
// documents, tags, keys that are not plain text, and bytes that are not UTF-8 text.
//
// The reader uses the event interface of yaml-cpp instead of YAML::Node. Limits then hold while reading. Aliases are
// copied, so no cycle can arise. Every node knows its line and column.
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
inline constexpr std::size_t kYamlNodesMax = 200'000;

// The text of the error is "place: message".
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
// Throws InputError if the file cannot be read or is not valid.
SourceNode read_yaml_file(const std::filesystem::path& file);

}  // namespace stopline
