#include "scenario/files/data_files.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "base/input_error.h"
#include "base/io/data_directory.h"
#include "base/nearest_name.h"
#include "scenario/load_scenario.h"
#include "scenario/yaml/yaml_source.h"

namespace stopline {
namespace {

constexpr std::size_t kReferenceMax = 1000;  // longest accepted name or path, in bytes

bool is_path(const std::string& reference) {
    return reference.find('/') != std::string::npos || reference.ends_with(".yaml");
}

}  // namespace

std::vector<std::string> data_names(const std::string& folder) {
    std::vector<std::string> names;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(data_directory() / folder, error)) {
        if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

DataFile read_data_file(const std::string& folder, const SourceNode& reference, const std::string& field,
                        Report& report) {
    DataFile file;
    file.tree.kind = SourceNode::Kind::broken;
    if (reference.kind != SourceNode::Kind::scalar || reference.text.empty() || reference.text.size() > kReferenceMax) {
        report.error(reference.place, "field '" + field + "': needs the name of a file in " + folder +
                                          known_names_hint("", data_names(folder)));
        return file;
    }
    std::filesystem::path path;
    if (is_path(reference.text)) {
        path = reference.place.source->directory / reference.text;
    } else {
        const std::vector<std::string> known = data_names(folder);
        if (std::find(known.begin(), known.end(), reference.text) == known.end()) {
            report.error(reference.place, "field '" + field + "': there is no '" + shortened(reference.text) + "' in " +
                                              (data_directory() / folder).generic_string() +
                                              known_names_hint(reference.text, known));
            return file;
        }
        path = data_directory() / folder / (reference.text + ".yaml");
    }
    file.stem = path.stem().string();
    report.add_file(path);
    try {
        file.tree = read_yaml_file(path);
    } catch (const InputError& error) {
        report.error(reference.place, "field '" + field + "': " + error.what());
    }
    return file;
}

}  // namespace stopline
