// Completes the tree of a scenario before it is read. Inserts default texts, named data files, single-word list entries
// and overrides. The reader then meets one complete form, and checks inherited and own values alike.
#pragma once

#include <filesystem>
#include <string>

#include "scenario/schema/field_table.h"

namespace stopline {

// Applies an override `path=value` (see load_scenario.h) to the map `root`. Completes each section on the path first,
// so that an override also reaches fields of a vehicle that the file gives by name only.
void apply_override(const Table& table, SourceNode& root, const std::string& text,
                    const std::filesystem::path& directory, Report& report);

// Completes a map and everything inside it.
void complete(const Table& table, SourceNode& map, const std::string& path, Report& report);

// Replaces the name of a data file by the content of that file. Merges a map with the data file that its `base` names.
// `folder` is a folder of the data directory.
void resolve_base(const Table& table, const std::string& folder, SourceNode& node, const std::string& path,
                  Report& report);

}  // namespace stopline
