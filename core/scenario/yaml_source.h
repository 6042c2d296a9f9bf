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

#include "scenario/source_node.h"

namespace stopline {

inline constexpr std::uintmax_t kYamlBytesMax = 16u << 20u;
inline constexpr std::size_t kYamlDepthMax = 32;
inline constexpr std::size_t kYamlNodesMax = 200'000;

// Both throw InputError with the position of the first error.
SourceNode parse_yaml(std::string_view text, std::shared_ptr<const Source> source);
SourceNode read_yaml_file(const std::filesystem::path& file);

}  // namespace stopline
