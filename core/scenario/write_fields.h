// Settings as YAML text by a table of fields: every field that applies, each number exact (see exact_text).
#pragma once

#include <string>

#include "scenario/field_table.h"

namespace stopline {

std::string write_fields(const Table& table, const void* settings, int indent = 0);

// One field's value in a line, for people: defaults in lists and in the schema. Nested maps give "".
std::string value_text(const FieldKind& kind, const void* settings);

}  // namespace stopline
