// Comma-separated values as in RFC 4180: a field with a comma, a quote or a line break is quoted. A column name ends
// with its unit (time_s, speed_mps, improvement_percent). An empty field means "no value".
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace stopline {

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

// Returns the number with a fixed count of decimals, with "0.000" in place of "-0.000". NaN gives the empty field.
std::string fixed(double number, int decimals);

struct CsvTable {
    std::string label;  // name of the file in messages
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
    std::vector<int> lines;  // [row] number of its first line in the file

    // Returns the index of a column. Throws InputError with a list of the columns if there is none of that name.
    std::size_t column(std::string_view name) const;
};

// Parses a table. Throws InputError with label and line for an unclosed quote or a wrong number of fields.
CsvTable parse_csv(std::string_view text, const std::string& label);

// Returns the number, or nothing if the text as a whole is not a finite number.
std::optional<double> parse_number(const std::string& text);

}  // namespace stopline
