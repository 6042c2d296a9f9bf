#include "scenario/schema/field_path.h"

#include <algorithm>
#include <functional>

#include "base/nearest_name.h"

namespace stopline {
namespace {

const Field* find_current_or_old(const Table& table, const std::string& name) {
    const Field* const field = table.find(name);
    return field != nullptr ? field : table.find_old_name(name);
}

// Returns the table of a section, or the table of the entries of a list if the path names an entry. Returns null
// otherwise.
const Table* inner_table(const Field& field, bool has_entry) {
    if (const auto* const section = std::get_if<SectionField>(&field.kind)) {
        return has_entry ? nullptr : &section->table();
    }
    const auto* const list = std::get_if<ListField>(&field.kind);
    return list != nullptr && has_entry ? &list->table() : nullptr;
}

std::string to_text(const std::vector<PathStep>& steps) {
    std::string text;
    for (const PathStep& step : steps) {
        text += (text.empty() ? "" : ".") + step.name;
        for (const std::string& entry : step.entries) text += "[" + entry + "]";
    }
    return text;
}

// Returns the brackets that stand for any entry of a list.
std::string any_entry(const Table& entries) { return entries.find("name") != nullptr ? "[NAME]" : "[0]"; }

// Appends the paths of all fields with this name inside a table. `path`: path of the table.
void append_paths(const Table& table, const std::string& path, const std::string& name,
                  std::vector<std::string>& paths) {
    for (const Field& field : table.fields) {
        const std::string here = join_path(path, field.name);
        if (field.name == name) paths.push_back(here);
        if (const auto* const section = std::get_if<SectionField>(&field.kind)) {
            append_paths(section->table(), here, name, paths);
        } else if (const auto* const list = std::get_if<ListField>(&field.kind)) {
            append_paths(list->table(), here + any_entry(list->table()), name, paths);
        }
    }
}

// Returns the paths of the fields with this name inside a table, those outside lists first. A list can repeat sections
// of the table, such as populations[NAME].components[0].driver; their fields are left out.
std::vector<std::string> paths_of_name(const Table& table, const std::string& path, const std::string& name) {
    std::vector<std::string> paths;
    append_paths(table, path, name, paths);
    const auto is_in_list = [](const std::string& one) { return one.find('[') != std::string::npos; };
    std::stable_partition(paths.begin(), paths.end(), std::not_fn(is_in_list));
    const std::vector<std::string> all = paths;
    std::erase_if(paths, [&](const std::string& one) {
        return std::any_of(all.begin(), all.end(),
                           [&](const std::string& other) { return one.ends_with("." + other); });
    });
    return paths;
}

}  // namespace

std::vector<PathStep> path_steps(const std::string& path) {
    std::vector<PathStep> steps(1);
    std::string* part = &steps.back().name;
    bool in_brackets = false;
    for (const char c : path) {
        if (c == '.' && !in_brackets) {
            part = &steps.emplace_back().name;
        } else if (c == '[' && !in_brackets) {
            part = &steps.back().entries.emplace_back();
            in_brackets = true;
        } else if (c == ']' && in_brackets) {
            in_brackets = false;
        } else {
            *part += c;
        }
    }
    return steps;
}

std::string entry_path(const std::string& list_path, const SourceNode& entry, std::size_t index) {
    const SourceNode* const name = entry.find("name");
    const bool named = name != nullptr && name->kind == SourceNode::Kind::scalar && is_name(name->text);
    return list_path + "[" + (named ? name->text : std::to_string(index)) + "]";
}

FieldAtPath find_field(const Table& root, const std::string& path) {
    const std::vector<PathStep> steps = path_steps(path);
    const Table* table = &root;
    std::string section;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        const std::string here = join_path(section, steps[i].name);
        const Field* const field = find_current_or_old(*table, steps[i].name);
        if (field == nullptr) {
            return {nullptr, nullptr,
                    "field '" + shortened(here) + "' is unknown" +
                        unknown_field_hint(root, *table, section, steps[i].name)};
        }
        const bool has_entry = !steps[i].entries.empty();
        if (i + 1 == steps.size()) return {table, has_entry ? nullptr : field, {}};
        if (const auto* const list = std::get_if<ListField>(&field->kind); list != nullptr && !has_entry) {
            const std::string problem = missing_entry_problem(*list, here, steps, i);
            return {nullptr, nullptr, "field '" + shortened(here) + "' " + problem};
        }
        table = inner_table(*field, has_entry);
        if (table == nullptr) {
            return {nullptr, nullptr,
                    "field '" + shortened(here) + "' has no field '" + steps[i + 1].name + "' inside"};
        }
        section = here;
    }
    return {};
}

std::string unknown_field_hint(const Table& root, const Table& table, const std::string& path,
                               const std::string& name) {
    constexpr std::size_t kSuggestedMax = 3;
    std::vector<std::string> paths = paths_of_name(table, path, name);
    if (paths.empty()) paths = paths_of_name(root, "", name);
    if (paths.empty()) return known_names_hint(name, table.names());
    if (paths.size() > kSuggestedMax) paths.resize(kSuggestedMax);
    return "; did you mean '" + joined(paths, "' or '") + "'? Known: " + joined(table.names());
}

std::string missing_entry_problem(const ListField& list, const std::string& list_path,
                                  const std::vector<PathStep>& steps, std::size_t i) {
    const Table& entries = list.table();
    const bool is_field = entries.find(steps[i + 1].name) != nullptr;
    const auto first = steps.begin() + static_cast<std::ptrdiff_t>(is_field ? i + 1 : i + 2);
    const std::string entry = is_field ? any_entry(entries) : "[" + steps[i + 1].name + "]";
    return "is a list: name its entry in brackets, as in '" +
           shortened(join_path(list_path + entry, to_text({first, steps.end()}))) + "'";
}

std::string current_path(const Table& root, const std::string& path) {
    std::vector<PathStep> steps = path_steps(path);
    const Table* table = &root;
    bool renamed = false;
    for (PathStep& step : steps) {
        const Field* const field = find_current_or_old(*table, step.name);
        if (field == nullptr) break;
        renamed = renamed || step.name != field->name;
        step.name = field->name;
        table = inner_table(*field, !step.entries.empty());
        if (table == nullptr) break;
    }
    return renamed ? to_text(steps) : path;
}

}  // namespace stopline
