#include "scenario/files/scenario_files.h"

#include <string_view>

#include "scenario/compose.h"
#include "scenario/schema/fields.h"
#include "scenario/schema/old_names.h"
#include "scenario/schema/report.h"
#include "scenario/yaml/yaml_source.h"

namespace stopline {

namespace {

// Appends the path in a scalar, or the paths in a list of scalars. Relative paths start at `directory`.
void append_paths(const SourceNode* node, const std::filesystem::path& directory,
                  std::vector<std::filesystem::path>& files) {
    if (node == nullptr) return;
    if (node->kind == SourceNode::Kind::scalar && !node->text.empty()) files.push_back(directory / node->text);
    if (node->kind != SourceNode::Kind::list) return;
    for (const SourceNode& item : node->items) append_paths(&item, directory, files);
}

void append_paths(const SourceNode& root, std::string_view section, const std::vector<std::string_view>& fields,
                  const std::filesystem::path& directory, std::vector<std::filesystem::path>& files) {
    const SourceNode* const map = root.find(section);
    if (map == nullptr || map->kind != SourceNode::Kind::map) return;
    for (const std::string_view field : fields) append_paths(map->find(field), directory, files);
}

}  // namespace

std::vector<std::filesystem::path> scenario_files(const std::filesystem::path& file,
                                                  const std::vector<std::string>& overrides) {
    std::vector<std::filesystem::path> files{file};
    SourceNode root = read_yaml_file(file);
    if (root.kind != SourceNode::Kind::map) return files;
    const std::filesystem::path directory = root.place.source->directory;
    Report report;
    replace_old_names(scenario_table(), root, "", report);
    const SourceNode without_overrides = root;
    for (const std::string& text : overrides)
        apply_override(scenario_table(), root, without_overrides, text, directory, report);
    complete(scenario_table(), root, "", report);
    files.insert(files.end(), report.files().begin(), report.files().end());
    append_paths(root, "network", {"net", "routes", "additional"}, directory, files);
    append_paths(root, "demand", {"counts", "od"}, directory, files);
    return files;
}

}  // namespace stopline
