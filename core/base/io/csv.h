// Writing and reading of comma-separated values (RFC 4180). A field that contains a comma, a quote or a line break is
// quoted. A column name ends with its unit (time_s, speed_mps, improvement_percent). An empty field means "no value".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stopline {

// Returns the text of a field for a CSV row: in quotes if it contains a comma, a quote or a line break.
std::string csv_field(const std::string& field);

// Builds the text of a table: one header line, then rows.
class CsvWriter {
public:
    explicit CsvWriter(const std::vector<std::string>& columns) : columns_(columns.size()) { row(columns); }

    // Appends a row. Throws std::logic_error if the number of fields differs from the number of columns.
    void row(const std::vector<std::string>& fields);
    const std::string& text() const { return text_; }

private:
    std::size_t columns_;
    std::string text_;
};

// Returns the number as text with the given number of decimals. A number that is rounded to 0 has no minus sign, and
// NaN becomes "".
std::string fixed(double number, int decimals);

struct CsvTable {
    std::string label;  // name of the file, for error messages
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
    std::vector<int> lines;  // [row] line of the file in which the row begins, counted from 1

    // Returns the index of the column `name`. Throws InputError, which lists all columns, if there is no such column.
    std::size_t column(std::string_view name) const;
};

// Parses a table whose first line holds the column names. `label` names the file in error messages. Throws InputError
// if the text is empty, semicolons separate its columns, a quote is not closed, or a row has the wrong number of
// fields.
CsvTable parse_csv(std::string_view text, const std::string& label);

// Converts the whole text to a number. Returns nothing if the text is not a finite number.
std::optional<double> parse_number(const std::string& text);

}  // namespace stopline
