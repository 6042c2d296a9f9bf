// Old names of result files, columns and cell values. They are kept for one release: tables with old names are read
// with a warning, and --old-column-names writes them.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace stopline {

// Names in result tables: those of this release, or those of the last one.
enum class ColumnNames { current, old };

inline constexpr const char* kOldNamesWarning =
    "--old-column-names: the next release removes this option; scenarios/COLUMNS.md lists the current names";

// Replaces old names while a table is read. Tables are named as in column_docs.h.
class OldNameReader {
public:
    explicit OldNameReader(std::string table) : table_(std::move(table)) {}

    // Returns the current name of a column.
    std::string column(const std::string& name);
    // Returns the current form of a cell value in the column with the current name `column`.
    std::string value(const std::string& column, const std::string& value);
    // One line for each old column name that was replaced.
    const std::vector<std::string>& warnings() const { return warnings_; }

private:
    std::string table_;
    std::map<std::string, std::string> known_;  // name in the table, current name
    std::vector<std::string> warnings_;
};

// Returns a table with the old names of its columns and cell values.
std::string with_old_names(std::string_view table, const std::string& csv);

struct ResultFile {
    std::string name;
    std::string text;
};
// Returns the file to write for a result table: unchanged, or with old file, column and value names.
ResultFile result_file(std::string_view table, std::string file, std::string csv, ColumnNames names);

// Returns all old names of columns, values and files as a Markdown section.
std::string old_names_markdown();

}  // namespace stopline
