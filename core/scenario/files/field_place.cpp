#include "scenario/files/field_place.h"

#include <fmt/format.h>

#include "scenario/schema/field_path.h"
#include "scenario/yaml/yaml_source.h"

namespace stopline {

std::string field_place(const std::filesystem::path& file, const std::vector<std::string>& overrides,
                        const std::string& path) {
    // An override of a section such as demand sets the fields in it, too. The last override holds.
    std::string place;
    for (const std::string& text : overrides) {
        if ((path + ".").starts_with(text.substr(0, text.find('=')) + ".")) place = fmt::format("--set '{}'", text);
    }
    if (!place.empty()) return place;
    const SourceNode root = read_yaml_file(file);
    const SourceNode* node = &root;
    for (const PathStep& step : path_steps(path)) {
        node = node->kind == SourceNode::Kind::map ? node->find(step.name) : nullptr;
        if (node == nullptr) return file.string();
    }
    return to_string(node->place);
}

}  // namespace stopline
