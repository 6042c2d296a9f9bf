// Paths to fields, as overrides and sweep axes write them: signal.green, populations[0].components[1].share,
// policies[CTG-Ref].time_gap.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenario/schema/field_table.h"

namespace stopline {

// One step of a path: the name of a field, and the list entries chosen in it by index or by name.
struct PathStep {
    std::string name;
    std::vector<std::string> entries;
};

std::vector<PathStep> path_steps(const std::string& path);

// Returns "populations[MIX]", or "populations[4]" for an entry without a usable name.
std::string entry_path(const std::string& list_path, const SourceNode& entry, std::size_t index);

// The field at a path, as far as the tables can tell. Only the file tells whether a list has a certain entry.
struct FieldAtPath {
    const Table* table = nullptr;  // the table of the field
    const Field* field = nullptr;  // null if there is a problem, or if the path ends in a list entry
    std::string problem;           // error text, such as "field 'signal.gren' is unknown; ..."
};

// Old names are found too.
FieldAtPath find_field(const Table& root, const std::string& path);

// Returns the path with old field names replaced by the current ones.
std::string current_path(const Table& root, const std::string& path);

}  // namespace stopline
