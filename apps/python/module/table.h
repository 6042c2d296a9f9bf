// The tables of a run, column by column.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stopline::python {

// A column of numbers or of texts. An empty cell of a column of numbers is NaN.
struct Column {
    std::string name;
    bool has_numbers = false;
    std::vector<double> numbers;     // empty in a column of texts
    std::vector<std::string> texts;  // empty in a column of numbers
};

struct Table {
    std::string name;
    std::vector<Column> columns;
    std::size_t rows = 0;
};

// Converts the text of a CSV table. A column has numbers if each cell is a number or empty. Hashes are texts. Throws
// InputError if the text is no table.
Table table_of_csv(std::string name, std::string_view csv);

}  // namespace stopline::python
