// Paths to fields as overrides and axes of sweeps write them: signal.green, populations[0].components[1].share,
// policies[CTG-Ref].time_gap.
#pragma once

#include <string>
#include <vector>

#include "scenario/field_table.h"

namespace stopline {

// One step of a path: a field's name with the entries of lists that are chosen, by number or by name.
struct PathStep {
    std::string name;
    std::vector<std::string> entries;
};

std::vector<PathStep> path_steps(const std::string& path);

// What a path leads to, as far as the table alone can tell: whether a list has such an entry depends on the file.
struct FieldAtPath {
    const Table* table = nullptr;  // that the field belongs to
    const Field* field = nullptr;  // null where there is a problem, or where the path ends in an entry of a list
    std::string problem;           // "field 'signal.gren' is unknown; ..."
};

FieldAtPath find_field(const Table& root, const std::string& path);

}  // namespace stopline
