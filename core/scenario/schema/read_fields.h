// Fills settings from a tree of text by a table of fields. Each value that cannot be used gives an error with its place
// and with what is allowed. Absent fields keep the defaults of the struct.
#pragma once

#include <string>

#include "scenario/schema/field_table.h"

namespace stopline {

// Reads a map of fields. `settings` points to a default-constructed struct of the table's type. `path` is the path of
// the map in messages, "" for the root. The settings are usable only if the report has no error afterwards.
void read_fields(const Table& table, const SourceNode& node, const std::string& path, void* settings, Report& report);

// Reads the value of one field of such a struct.
void read_value(const Field& field, const SourceNode& node, const std::string& path, void* settings, Report& report);

}  // namespace stopline
