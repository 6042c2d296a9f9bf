#include "scenario/compose.h"

#include <algorithm>
#include <memory>
#include <string>
#include <unordered_map>
#include <utility>

#include "base/input_error.h"
#include "base/nearest_name.h"
#include "scenario/files/data_files.h"
#include "scenario/schema/field_path.h"
#include "scenario/schema/old_names.h"
#include "scenario/yaml/yaml_source.h"

namespace stopline {
namespace {

constexpr int kBasesMax = 8;  // longest chain of data files in which each file names the next one as its `base`

using Kind = SourceNode::Kind;

// Overwrites values in `base` with the values in `own`. Sections are merged field by field. Any other value is replaced
// as a whole.
void merge(const Table& table, SourceNode& base, SourceNode own) {
    for (std::size_t i = 0; i < own.keys.size(); ++i) {
        SourceNode* const base_value = base.find(own.keys[i].text);
        const Field* const field = table.find(own.keys[i].text);
        const SectionField* const section = field == nullptr ? nullptr : std::get_if<SectionField>(&field->kind);
        if (base_value == nullptr) {
            base.add(std::move(own.keys[i]), std::move(own.items[i]));
        } else if (section != nullptr && base_value->kind == Kind::map && own.items[i].kind == Kind::map) {
            merge(section->table(), *base_value, std::move(own.items[i]));
        } else {
            *base_value = std::move(own.items[i]);
        }
    }
}

SourceNode without_base(SourceNode map) {
    for (std::size_t i = 0; i < map.keys.size(); ++i) {
        if (map.keys[i].text != "base") continue;
        map.keys.erase(map.keys.begin() + static_cast<std::ptrdiff_t>(i));
        map.items.erase(map.items.begin() + static_cast<std::ptrdiff_t>(i));
        break;
    }
    return map;
}

SourceNode scalar_at(const Place& place, std::string text) {
    SourceNode node;
    node.kind = Kind::scalar;
    node.place = place;
    node.text = std::move(text);
    return node;
}

// Implements resolve_base(). `bases` is the number of data files that have already been read for this node.
void resolve(const Table& table, const std::string& folder, SourceNode& node, const std::string& path, int bases,
             Report& report) {
    const SourceNode* const inner = node.kind == Kind::map ? node.find("base") : nullptr;
    if (node.kind != Kind::scalar && inner == nullptr) return;
    const SourceNode reference = inner != nullptr ? *inner : node;
    SourceNode own = without_base(std::move(node));
    node = SourceNode{};
    node.kind = Kind::broken;
    if (bases >= kBasesMax) {
        report.error(reference.place, "field '" + path + "': the chain of base files is longer than " +
                                          std::to_string(kBasesMax) + " files");
        return;
    }
    DataFile file = read_data_file(folder, reference, path, report);
    if (file.tree.kind != Kind::map) {
        if (file.tree.kind != Kind::broken) {
            report.error(file.tree.place, "the file needs a map of fields (fields: " + joined(table.names()) + ")");
        }
        return;
    }
    replace_old_names(table, file.tree, path, report);
    if (table.find("name") != nullptr && file.tree.find("name") == nullptr) {
        file.tree.add({"name", reference.place}, scalar_at(reference.place, file.stem));
    }
    resolve(table, folder, file.tree, path, bases + 1, report);
    if (file.tree.kind == Kind::map && own.kind == Kind::map) merge(table, file.tree, std::move(own));
    node = std::move(file.tree);
}

const SourceNode* name_of(const SourceNode& item) { return item.kind == Kind::map ? item.find("name") : nullptr; }

// Replaces `list` by the list in the library file "folder/name", combined with the entries of `list`. An entry of
// `list` replaces the library entry of the same name. All other entries of `list` are appended.
void merge_library_list(const Field& field, const std::string& library, SourceNode& list, Report& report) {
    if (list.kind != Kind::list) return;
    const auto slash = library.find('/');
    DataFile file =
        read_data_file(library.substr(0, slash), scalar_at(list.place, library.substr(slash + 1)), field.name, report);
    SourceNode* const known = file.tree.find(field.name);
    if (file.tree.kind == Kind::broken) {
        list.kind = Kind::broken;
        return;
    }
    if (known == nullptr || known->kind != Kind::list || file.tree.keys.size() != 1) {
        report.error(file.tree.place, "needs the field '" + field.name + "' with a list, and no other field");
        list.kind = Kind::broken;
        return;
    }
    replace_old_names(field, *known, field.name, report);
    // The entries of the library that the scenario has not replaced, by name. A name that the scenario gives twice thus
    // stays in the list twice, and a later check reports it.
    std::unordered_map<std::string, std::size_t> library_entries;
    for (std::size_t i = 0; i < known->items.size(); ++i) {
        if (const SourceNode* const name = name_of(known->items[i])) library_entries.emplace(name->text, i);
    }
    for (SourceNode& own : list.items) {
        const SourceNode* const name = name_of(own);
        const auto replaced = name == nullptr ? library_entries.end() : library_entries.find(name->text);
        if (replaced == library_entries.end()) {
            known->items.push_back(std::move(own));
        } else {
            known->items[replaced->second] = std::move(own);
            library_entries.erase(replaced);
        }
    }
    list.items = std::move(known->items);
}

// Returns the value of the choice field at `path` (names of fields, joined by dots). If `map` has no value for the
// field, returns the default of the field.
std::string choice_at(const Table& table, const SourceNode* map, const std::string& path) {
    const auto dot = path.find('.');
    const std::string name = path.substr(0, dot);
    const SourceNode* const value = map == nullptr ? nullptr : map->find(name);
    const FieldKind& kind = table.find(name)->kind;
    if (dot != std::string::npos) {
        return choice_at(std::get<SectionField>(kind).table(), value, path.substr(dot + 1));
    }
    return value != nullptr ? value->text : std::get<ChoiceField>(kind).get(table.make_default().get());
}

// Returns true if the field exists for the choices in `map`, see Field::condition_field.
bool exists(const Table& table, const Field& field, const SourceNode& map) {
    if (field.condition_field.empty()) return true;
    const std::string choice = choice_at(table, &map, field.condition_field);
    return std::find(field.condition_values.begin(), field.condition_values.end(), choice) !=
           field.condition_values.end();
}

// Completes one field. If the file does not give the field, inserts its default, unless the field is tied to another
// choice. Inserts the content of a data file or library list that the field names. Turns list entries that are a single
// word into maps. Does not complete the fields inside a map or a list.
void complete_field(const Table& table, const Field& field, SourceNode& map, const std::string& path, Report& report) {
    SourceNode* value = map.find(field.name);
    const auto* const section = std::get_if<SectionField>(&field.kind);
    const auto* const list = std::get_if<ListField>(&field.kind);
    if (value == nullptr && !field.fallback.empty() && exists(table, field, map)) {
        const auto directory = map.place.source->directory;
        const auto source = std::make_shared<Source>(Source{"default of '" + path + "'", directory});
        value = &map.add({field.name, map.place}, parse_yaml(field.fallback, source));
    }
    if (value == nullptr) return;
    if (section != nullptr && !section->library.empty()) {
        resolve_base(section->table(), section->library, *value, path, report);
    }
    if (list == nullptr) return;
    if (!list->library.empty()) merge_library_list(field, list->library, *value, report);
    for (SourceNode& item : value->items) {
        if (item.kind == Kind::scalar && list->table().expand != nullptr) item = list->table().expand(item);
    }
}

// Returns the list entry with this name; null if there is none.
template <class List>
auto* find_entry_by_name(List& list, const std::string& name) {
    const auto found = std::find_if(list.items.begin(), list.items.end(), [&](const SourceNode& item) {
        return name_of(item) != nullptr && name_of(item)->text == name;
    });
    return found == list.items.end() ? nullptr : &*found;
}

// Returns the list entry with the index or the name `entry`; null if there is none.
SourceNode* find_entry(SourceNode& list, const std::string& entry) {
    const ParsedWhole index = parse_whole(entry);
    if (index.problem.empty()) return index.value < list.items.size() ? &list.items[index.value] : nullptr;
    return find_entry_by_name(list, entry);
}

// Returns the end of a message about a list without an entry `wanted`: the most similar name, and all entries.
std::string entries_hint(const SourceNode& list, const std::string& wanted) {
    std::vector<std::string> names;
    for (const SourceNode& item : list.items) {
        if (name_of(item) != nullptr) names.push_back(name_of(item)->text);
    }
    const std::string nearest = nearest_name(wanted, names);
    return (nearest.empty() ? "; it has" : "; did you mean '" + nearest + "'? It has") + " the entries 0 to " +
           std::to_string(list.items.size() - 1) + (names.empty() ? "" : " (" + joined(names) + ")");
}

// Sets the field at a path to a value. Reports an error if the path does not exist.
class Setter {
public:
    // `root`: the table of the whole file. `file`: the tree before all overrides.
    Setter(SourceNode value, const Table& root, const SourceNode& file, Report& report)
        : value_(std::move(value)), root_(root), file_(file), report_(report) {}

    void set(const Table& table, SourceNode& map, const std::vector<PathStep>& steps, std::size_t i,
             const std::string& path) {
        const PathStep& step = steps[i];
        const std::string here = join_path(path, step.name);
        const Field* const field = table.find(step.name);
        if (field == nullptr) {
            return error(here, "is unknown" + unknown_field_hint(root_, table, path, step.name));
        }
        reached_ = join_path(reached_, step.name);
        const bool last = i + 1 == steps.size();
        if (last && step.entries.empty()) {
            replace_old_names(*field, value_, here, report_);
            if (i == 0) use_entries_of_file(table, *field);
            SourceNode* const present = map.find(step.name);
            if (present != nullptr) {
                *present = std::move(value_);
            } else {
                map.add({step.name, value_.place}, std::move(value_));
            }
            return;
        }
        complete_field(table, *field, map, here, report_);
        if (!step.entries.empty()) return set_entry(*field, map, steps, i, here);
        if (const auto* const list = std::get_if<ListField>(&field->kind)) {
            return error(here, missing_entry_problem(*list, here, steps, i));
        }
        const auto* const section = std::get_if<SectionField>(&field->kind);
        if (section == nullptr) return error(here, "has no field '" + steps[i + 1].name + "' inside");
        SourceNode* inner = map.find(step.name);
        if (inner == nullptr) {
            SourceNode empty;
            empty.kind = Kind::map;
            empty.place = map.place;
            inner = &map.add({step.name, map.place}, std::move(empty));
        }
        if (inner->kind == Kind::map) set(section->table(), *inner, steps, i + 1, here);
    }

    // Returns the path to the value that has been set, with the numbers of list entries in place of their names.
    const std::string& reached() const { return reached_; }

private:
    // Replaces a name in the new list by the entry of this name in the file. Thus --set 'populations=[MIX]' selects a
    // population that the file describes. Does so only in lists whose entries can be a single word.
    void use_entries_of_file(const Table& table, const Field& field) {
        const auto* const items = std::get_if<ListField>(&field.kind);
        if (items == nullptr || items->table().expand == nullptr || value_.kind != Kind::list) return;
        SourceNode file = file_;
        complete_field(table, field, file, field.name, report_);
        const SourceNode* const list = file.find(field.name);
        if (list == nullptr) return;
        for (SourceNode& item : value_.items) {
            if (item.kind != Kind::scalar) continue;
            if (const SourceNode* const entry = find_entry_by_name(*list, item.text)) item = *entry;
        }
    }

    void set_entry(const Field& field, SourceNode& map, const std::vector<PathStep>& steps, std::size_t i,
                   const std::string& path) {
        SourceNode* const list = map.find(field.name);
        const bool last = i + 1 == steps.size();
        const std::string& wanted = steps[i].entries.front();
        if (list == nullptr || list->kind != Kind::list || list->items.empty() || steps[i].entries.size() > 1) {
            return error(path, "has no entry [" + shortened(wanted) + "] to set");
        }
        SourceNode* const entry = find_entry(*list, wanted);
        if (entry == nullptr)
            return error(path, "has no entry [" + shortened(wanted) + "]" + entries_hint(*list, wanted));
        reached_ += "[" + std::to_string(entry - list->items.data()) + "]";
        const auto* const items = std::get_if<ListField>(&field.kind);
        if (last) {
            if (items != nullptr) replace_old_names(items->table(), value_, path + "[" + wanted + "]", report_);
            *entry = std::move(value_);
            return;
        }
        if (items == nullptr || entry->kind != Kind::map) return error(path, "has no fields in its entries");
        set(items->table(), *entry, steps, i + 1, path + "[" + wanted + "]");
    }

    void error(const std::string& path, const std::string& message) {
        report_.error(value_.place, "field '" + shortened(path) + "' " + message);
    }

    SourceNode value_;
    const Table& root_;
    const SourceNode& file_;
    Report& report_;
    std::string reached_;
};

}  // namespace

void resolve_base(const Table& table, const std::string& folder, SourceNode& node, const std::string& path,
                  Report& report) {
    resolve(table, folder, node, path, 0, report);
}

void complete(const Table& table, SourceNode& map, const std::string& path, Report& report) {
    if (map.kind != Kind::map) return;
    for (const Field& field : table.fields) {
        const std::string field_path = join_path(path, field.name);
        complete_field(table, field, map, field_path, report);
        SourceNode* value = map.find(field.name);
        const auto* const own_section = std::get_if<SectionField>(&field.kind);
        if (value == nullptr && own_section != nullptr && !own_section->is_optional && !field.required &&
            exists(table, field, map)) {
            // The file does not give the section. An empty section is added; complete() below inserts its defaults.
            SourceNode empty;
            empty.kind = Kind::map;
            empty.place = map.place;
            value = &map.add({field.name, map.place}, std::move(empty));
        }
        if (value == nullptr) continue;
        if (const auto* const section = std::get_if<SectionField>(&field.kind)) {
            complete(section->table(), *value, field_path, report);
        } else if (const auto* const list = std::get_if<ListField>(&field.kind)) {
            for (std::size_t i = 0; i < value->items.size(); ++i) {
                complete(list->table(), value->items[i], field_path + "[" + std::to_string(i) + "]", report);
            }
        }
    }
}

std::string apply_override(const Table& table, SourceNode& root, const SourceNode& file, const std::string& text,
                           const std::filesystem::path& directory, Report& report) {
    const auto equals = text.find('=');
    const auto source = std::make_shared<Source>(Source{"--set '" + shortened(text) + "'", directory, false});
    const Place place{source};
    if (equals == std::string::npos || equals == 0) {
        report.error(place, "needs the form path=value, for instance signal.green=20 s");
        return {};
    }
    const std::string written = text.substr(0, equals);
    const std::string path = current_path(table, written);
    if (path != written) report.warn(place, old_name_warning(shortened(written), shortened(path)));
    try {
        SourceNode value = parse_yaml(std::string_view(text).substr(equals + 1), source);
        Setter setter(std::move(value), table, file, report);
        setter.set(table, root, path_steps(path), 0, "");
        return setter.reached();
    } catch (const YamlError& error) {
        report.error(place, error.message());
    }
    return {};
}

}  // namespace stopline
