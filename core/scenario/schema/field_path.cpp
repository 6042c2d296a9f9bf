#include "scenario/schema/field_path.h"

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
    std::string here;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        here = join_path(here, steps[i].name);
        const Field* const field = find_current_or_old(*table, steps[i].name);
        if (field == nullptr) {
            return {nullptr, nullptr,
                    "field '" + shortened(here) + "' is unknown" + known_names_hint(steps[i].name, table->names())};
        }
        const bool has_entry = !steps[i].entries.empty();
        if (i + 1 == steps.size()) return {table, has_entry ? nullptr : field, {}};
        table = inner_table(*field, has_entry);
        if (table == nullptr) {
            return {nullptr, nullptr,
                    "field '" + shortened(here) + "' has no field '" + steps[i + 1].name + "' inside"};
        }
    }
    return {};
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
