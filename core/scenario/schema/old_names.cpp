#include "scenario/schema/old_names.h"

#include <cstddef>

#include "scenario/schema/field_path.h"

namespace stopline {
namespace {

constexpr const char* kRemoval = "; the old name will be removed in the next release";

void erase_entry(SourceNode& map, std::size_t i) {
    map.keys.erase(map.keys.begin() + static_cast<std::ptrdiff_t>(i));
    map.items.erase(map.items.begin() + static_cast<std::ptrdiff_t>(i));
}

void replace_old_value(const Field& field, SourceNode& value, const std::string& path, Report& report) {
    if (value.kind != SourceNode::Kind::scalar) return;
    for (const OldValue& old : field.old_values) {
        if (value.text != old.old_name) continue;
        report.warn(value.place,
                    "field '" + path + "': value '" + old.old_name + "' is now called '" + old.name + "'" + kRemoval);
        value.text = old.name;
        return;
    }
}

}  // namespace

std::string old_name_warning(const std::string& old_path, const std::string& current_path) {
    return "field '" + old_path + "' is now called '" + current_path + "'" + kRemoval;
}

std::string both_names_error(const std::string& old_path, const std::string& current_path) {
    return "field '" + old_path + "' is the old name of '" + current_path +
           "', which is given too: keep the new name only";
}

void replace_old_names(const Table& table, SourceNode& map, const std::string& path, Report& report) {
    if (map.kind != SourceNode::Kind::map) return;
    for (std::size_t i = 0; i < map.keys.size();) {
        SourceNode::Key& key = map.keys[i];
        const Field* field = table.find(key.text);
        if (field == nullptr) {
            field = table.find_old_name(key.text);
            if (field == nullptr) {  // read_fields.cpp reports unknown fields
                ++i;
                continue;
            }
            const std::string old_path = join_path(path, key.text);
            const std::string new_path = join_path(path, field->name);
            if (map.find(field->name) != nullptr) {
                report.error(key.place, both_names_error(old_path, new_path));
                erase_entry(map, i);
                continue;
            }
            report.warn(key.place, old_name_warning(old_path, new_path));
            key.text = field->name;
        }
        replace_old_names(*field, map.items[i], join_path(path, field->name), report);
        ++i;
    }
}

void replace_old_names(const Field& field, SourceNode& value, const std::string& path, Report& report) {
    if (const auto* const section = std::get_if<SectionField>(&field.kind)) {
        replace_old_names(section->table(), value, path, report);
    } else if (const auto* const list = std::get_if<ListField>(&field.kind)) {
        for (std::size_t i = 0; i < value.items.size(); ++i) {
            replace_old_names(list->table(), value.items[i], entry_path(path, value.items[i], i), report);
        }
    } else {
        replace_old_value(field, value, path, report);
    }
}

}  // namespace stopline
