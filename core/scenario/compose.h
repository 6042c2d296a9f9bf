// Completes the tree of a scenario before it is read: defaults that are written as text, files that are named, entries
// written as a single word, and overrides from the command line. What comes out says everything a file could say, so the
// reader knows one form only and checks inherited and own values alike.
#pragma once

#include <filesystem>
#include <string>

#include "scenario/field_table.h"

namespace stopline {

// Applies `path=value` (see load_scenario.h) to the map `root`. Parts of the tree that the path enters are completed, so
// that an override reaches into a vehicle that the file only names.
void apply_override(const Table& table, SourceNode& root, const std::string& text,
                    const std::filesystem::path& directory, Report& report);

void complete(const Table& table, SourceNode& map, const std::string& path, Report& report);

// Completes a tree that may be a file's name or have a `base` in a folder of the data directory.
void resolve_base(const Table& table, const std::string& folder, SourceNode& node, const std::string& path,
                  Report& report);

}  // namespace stopline
