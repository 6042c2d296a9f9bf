// Old names of result files, columns and cell values. They are kept for one release. Programs read tables with old
// names and give a warning. The option --old-column-names makes programs write old names.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/io/csv.h"

namespace stopline {

// The kind of names in result tables: names of this release, or names of the previous release.
enum class ColumnNames { current, old };

inline constexpr const char* kOldNamesWarning =
    "--old-column-names: the next release removes this option; scenarios/COLUMNS.md lists the current names";

// Translates the old names in one table while it is read. `table` is a table name as in column_docs.h.
class OldNameReader {
public:
    explicit OldNameReader(std::string table) : table_(std::move(table)) {}

    // Returns the current name of a column. An old name adds a warning.
    std::string column(const std::string& name);
    // Returns the current form of a cell value. `column` is the current name of its column.
    std::string value(const std::string& column, const std::string& value);
    // Returns one line for each old column name that was replaced.
    const std::vector<std::string>& warnings() const { return warnings_; }

private:
    std::string table_;
    std::map<std::string, std::string> known_;  // name in the table -> current name
    std::vector<std::string> warnings_;
};

// Replaces the old names of the columns of a table that was read from a file. `name` is the table name in the list of
// old names, such as "data/paper/quick.csv". Returns one warning for each old name.
std::vector<std::string> use_current_column_names(std::string_view name, CsvTable& table);

// Returns the CSV text with the old names of its columns and cell values.
std::string with_old_names(std::string_view table, const std::string& csv);

// Returns the name of the file for a result table, which is `file` or its old name.
std::string result_file_name(std::string_view table, std::string file, ColumnNames names);

struct ResultFile {
    std::string name;
    std::string text;
};
// Returns name and text of the file to write for a result table. If `names` is `old`, replaces the names of the file,
// of the columns and of cell values by old names.
ResultFile result_file(std::string_view table, std::string file, std::string csv, ColumnNames names);

// Returns all old names of columns, values and files as a Markdown section.
std::string old_names_markdown();

}  // namespace stopline
