// Fills settings from a tree of text by a table of fields, and says of every value that cannot be used where it stands and
// what is allowed. Fields that are absent keep the struct's defaults.
#pragma once

#include <string>

#include "scenario/field_table.h"

namespace stopline {

// `settings` points to a default-constructed struct of the table's type; `path` is its path in messages ("" : the root).
// Errors go to the report; the settings are usable only if there are none.
void read_fields(const Table& table, const SourceNode& node, const std::string& path, void* settings, Report& report);

// The same for one field of such a struct.
void read_value(const Field& field, const SourceNode& node, const std::string& path, void* settings, Report& report);

}  // namespace stopline
