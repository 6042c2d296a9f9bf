// Reads a YAML tree into a settings struct, as a table of fields describes it. Each unusable value gives an error with
// its position and the allowed values. Fields that the tree does not give keep the defaults of the struct.
#pragma once

#include <string>

#include "scenario/schema/field_table.h"

namespace stopline {

// Reads a map of fields. `settings` points to a default-constructed struct of the table's type. `path` is the path of
// the map in messages, "" for the root. `library`: folder of the data files that the map can name as its `base`; "":
// none. The settings are usable only if the report has no error afterwards.
void read_fields(const Table& table, const SourceNode& node, const std::string& path, void* settings, Report& report,
                 const std::string& library = {});

// Reads the value of one field into `settings`, which points to a struct of the type of the field's table.
void read_value(const Field& field, const SourceNode& node, const std::string& path, void* settings, Report& report);

}  // namespace stopline
