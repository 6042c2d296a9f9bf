// Replaces names of fields and of choice values that were valid in the previous release and that files may still use.
//
// The old names in a YAML tree are replaced before other code reads the tree, so all other code handles current names
// only. Each old name gives a warning with its file and line. Row::renamed_from() adds an old name to a field.
#pragma once

#include <string>

#include "scenario/schema/field_table.h"

namespace stopline {

// Replaces old names in a map and in everything inside it. `path` is the path of the map in messages.
// Reports an error if a map has both the old and the new name of a field.
void replace_old_names(const Table& table, SourceNode& map, const std::string& path, Report& report);

// Replaces old names in the value of one field.
void replace_old_names(const Field& field, SourceNode& value, const std::string& path, Report& report);

// Returns the text of a warning: "field 'old' is now called 'new'; the old name will be removed in the next release".
std::string old_name_warning(const std::string& old_path, const std::string& current_path);

// Returns the text of the error for a field that is given by its old and by its new name.
std::string both_names_error(const std::string& old_path, const std::string& current_path);

}  // namespace stopline
