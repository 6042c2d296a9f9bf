// Comma-separated values as in RFC 4180: a field with a comma, a quote or a line break stands in quotes. Columns carry their
// unit as the end of their name (time_s, speed_mps, improvement_percent); empty fields mean "none".
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stopline {

// The text of a table: one header line, then rows of as many fields.
class CsvWriter {
public:
    explicit CsvWriter(const std::vector<std::string>& columns) : columns_(columns.size()) { row(columns); }

    void row(const std::vector<std::string>& fields);
    const std::string& text() const { return text_; }

private:
    std::size_t columns_;
    std::string text_;
};

// A number with a fixed count of decimals, never "-0.000"; NaN is the empty field.
std::string fixed(double number, int decimals);

struct CsvTable {
    std::string label;  // of the file, for messages
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
    std::vector<int> lines;  // [row] where it begins

    // Index of a column; throws InputError that lists the columns.
    std::size_t column(std::string_view name) const;
};

// Throws InputError with label and line: an unfinished quote, or a row with too many or too few fields.
CsvTable parse_csv(std::string_view text, const std::string& label);

}  // namespace stopline
