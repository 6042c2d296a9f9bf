// Writes settings as YAML text by a table of fields: every field that applies, each number exactly (exact_text).
#pragma once

#include <string>

#include "scenario/schema/field_table.h"

namespace stopline {

// `indent` is the number of spaces before each line.
std::string write_fields(const Table& table, const void* settings, int indent = 0);

// Returns the value of one field in a line with rounded numbers, as the default column shows it. Nested maps give "".
std::string value_text(const FieldKind& kind, const void* settings);

}  // namespace stopline
