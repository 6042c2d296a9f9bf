#pragma once

#include <functional>
#include <string>

#include "scenario/schema/field_table.h"

namespace stopline {

// Calls `visit` for every row reachable from a table, with its path. The entries of a list have the path name[]. Leaves
// out the rows of optional sections, which repeat those of another section.
inline void visit_rows(const Table& table, const std::string& path,
                       const std::function<void(const Table&, const Field&, const std::string&)>& visit) {
    for (const Field& field : table.fields) {
        const std::string field_path = join_path(path, field.name);
        visit(table, field, field_path);
        const auto* const section = std::get_if<SectionField>(&field.kind);
        if (section != nullptr && !section->is_optional) visit_rows(section->table(), field_path, visit);
        if (const auto* const list = std::get_if<ListField>(&field.kind))
            visit_rows(list->table(), field_path + "[]", visit);
    }
}

}  // namespace stopline
