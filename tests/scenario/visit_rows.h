#pragma once

#include <functional>
#include <string>

#include "scenario/schema/field_table.h"

namespace stopline {

// Visits every row reachable from a table, with its path. A list has the path name[].
inline void visit_rows(const Table& table, const std::string& path,
                       const std::function<void(const Table&, const Field&, const std::string&)>& visit) {
    for (const Field& field : table.fields) {
        const std::string here = join_path(path, field.name);
        visit(table, field, here);
        if (const auto* const section = std::get_if<SectionField>(&field.kind))
            visit_rows(section->table(), here, visit);
        if (const auto* const list = std::get_if<ListField>(&field.kind)) visit_rows(list->table(), here + "[]", visit);
    }
}

}  // namespace stopline
