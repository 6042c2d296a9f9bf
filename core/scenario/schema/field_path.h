// Paths of fields in overrides and sweep axes, such as signal.green, populations[0].components[1].share or
// policies[CTG-Ref].time_gap.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "scenario/schema/field_table.h"

namespace stopline {

// One step of a path: the name of a field, and the texts in the brackets after it. Each text in brackets is the index
// or the name of a list entry.
struct PathStep {
    std::string name;
    std::vector<std::string> entries;
};

// Splits a path at its dots and brackets.
std::vector<PathStep> path_steps(const std::string& path);

// Returns the path of a list entry with its name, such as "populations[MIX]". For an entry without a valid name,
// returns the path with the index, such as "populations[4]".
std::string entry_path(const std::string& list_path, const SourceNode& entry, std::size_t index);

// The result of find_field().
struct FieldAtPath {
    const Table* table = nullptr;  // table that has the row of the field; null if there is a problem
    const Field* field = nullptr;  // null if there is a problem, or if the path ends in a list entry
    std::string problem;           // error text, such as "field 'signal.gren' is unknown; ..."
};

// Finds the field at a path, which may use old names of fields. Does not check that a list has the entry in brackets,
// because this depends on the scenario file.
FieldAtPath find_field(const Table& root, const std::string& path);

// Returns the end of a message about an unknown field `name` in the section at `path`, which has the fields of `table`:
// "; did you mean 'driver.free_drive.hesitation'? Known: ...". Suggests the fields of this name inside the section or,
// if there are none, elsewhere in `root`. If there are none either, suggests the most similar field of the section.
std::string unknown_field_hint(const Table& root, const Table& table, const std::string& path, const std::string& name);

// Returns the problem of a path that names a list at `steps[i]` without an entry in brackets, such as
// policies.CTG-Ref.time_gap: "is a list: name its entry in brackets, as in 'policies[CTG-Ref].time_gap'". `list_path`:
// path up to and including the list.
std::string missing_entry_problem(const ListField& list, const std::string& list_path,
                                  const std::vector<PathStep>& steps, std::size_t i);

// Returns the path with old field names replaced by the current ones.
std::string current_path(const Table& root, const std::string& path);

}  // namespace stopline
