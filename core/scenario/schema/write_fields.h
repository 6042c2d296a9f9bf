// Writes a settings struct as YAML text, as a table of fields describes it.
#pragma once

#include <string>

#include "scenario/schema/field_table.h"

namespace stopline {

// Returns the YAML text of a settings struct, with exact numbers (exact_text()). Leaves out empty texts, and fields
// that do not exist because their condition is not fulfilled. `indent` is the number of spaces before each line.
std::string write_fields(const Table& table, const void* settings, int indent = 0);

// Returns the value of one field in one line with rounded numbers, for the defaults in the list of fields. Returns ""
// for sections, lists of maps or texts, and curves.
std::string value_text(const FieldKind& kind, const void* settings);

}  // namespace stopline
