#include "scenario/field_path.h"

#include "scenario/nearest_name.h"

namespace stopline {

std::vector<PathStep> path_steps(const std::string& path) {
    std::vector<PathStep> steps(1);
    std::string* part = &steps.back().name;
    bool inside = false;
    for (const char c : path) {
        if (c == '.' && !inside) {
            part = &steps.emplace_back().name;
        } else if (c == '[' && !inside) {
            part = &steps.back().entries.emplace_back();
            inside = true;
        } else if (c == ']' && inside) {
            inside = false;
        } else {
            *part += c;
        }
    }
    return steps;
}

FieldAtPath find_field(const Table& root, const std::string& path) {
    const std::vector<PathStep> steps = path_steps(path);
    const Table* table = &root;
    std::string here;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        here = join_path(here, steps[i].name);
        const Field* const field = table->find(steps[i].name);
        if (field == nullptr) {
            return {nullptr, nullptr,
                    "field '" + shortened(here) + "' is unknown" + known_names(steps[i].name, table->names())};
        }
        const bool entry = !steps[i].entries.empty();
        if (i + 1 == steps.size()) return {table, entry ? nullptr : field, {}};
        const auto* const section = std::get_if<SectionField>(&field->kind);
        const auto* const list = std::get_if<ListField>(&field->kind);
        if (section != nullptr && !entry) {
            table = &section->table();
        } else if (list != nullptr && entry) {
            table = &list->table();
        } else {
            return {nullptr, nullptr,
                    "field '" + shortened(here) + "' has no field '" + steps[i + 1].name + "' inside"};
        }
    }
    return {};
}

}  // namespace stopline
