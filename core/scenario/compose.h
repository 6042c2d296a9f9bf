// Completes the YAML tree of a scenario before read_fields.h reads it. Applies overrides, and inserts defaults and the
// contents of named data files. read_fields.h then checks all values, wherever they come from.
#pragma once

#include <filesystem>
#include <string>

#include "scenario/schema/field_table.h"

namespace stopline {

// Applies an override `path=value` (see load_scenario.h) to the map `root`. First completes each section on the path,
// so that vehicle.mass can be set even if the file gives only the name of a vehicle. Relative file names in the value
// start at `directory`. Returns the path to the value, with the numbers of list entries in place of their names.
// `file` is the tree before all overrides. A name in populations=[...] stands for the population of this name in it.
std::string apply_override(const Table& table, SourceNode& root, const SourceNode& file, const std::string& text,
                           const std::filesystem::path& directory, Report& report);

// Inserts the defaults and the data files of a map and of all maps inside it. `path` is the path of the map, for
// messages.
void complete(const Table& table, SourceNode& map, const std::string& path, Report& report);

// Resolves a reference to a data file in `folder`, a folder of the data directory. If `node` is a file name, replaces
// it by the content of the file. If `node` is a map with the key `base`, reads the file that `base` names. The other
// fields of the map then overwrite fields of the file.
void resolve_base(const Table& table, const std::string& folder, SourceNode& node, const std::string& path,
                  Report& report);

}  // namespace stopline
