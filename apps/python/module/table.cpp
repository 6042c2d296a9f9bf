#include "module/table.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "base/io/csv.h"

namespace stopline::python {

namespace {

Column column_of(const CsvTable& csv, std::size_t k) {
    Column column;
    column.name = csv.columns[k];
    column.has_numbers = !column.name.ends_with("hash");
    for (const std::vector<std::string>& row : csv.rows) {
        const std::optional<double> number = row[k].empty() ? std::nullopt : parse_number(row[k]);
        column.has_numbers = column.has_numbers && (row[k].empty() || number);
        column.numbers.push_back(number.value_or(std::numeric_limits<double>::quiet_NaN()));
    }
    if (column.has_numbers) return column;
    column.numbers.clear();
    for (const std::vector<std::string>& row : csv.rows) column.texts.push_back(row[k]);
    return column;
}

}  // namespace

Table table_of_csv(std::string name, std::string_view csv) {
    const CsvTable parsed = parse_csv(csv, name);
    Table table;
    table.name = std::move(name);
    table.rows = parsed.rows.size();
    for (std::size_t k = 0; k < parsed.columns.size(); ++k) table.columns.push_back(column_of(parsed, k));
    return table;
}

}  // namespace stopline::python
