// Parts of the tables of metrics that do not depend on the kind of run.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stopline {

// A metric in a list for users.
struct ListedMetric {
    std::string column;
    std::string unit;
    std::string meaning;  // first statement of the meaning
};

// The heading lines of a console table.
class ConsoleHead {
public:
    // Adds a column. The lines of `heading` are separated by '\n'. Its last line is directly above the unit.
    void add(std::string_view heading, std::string_view unit);
    // Adds a column with a vertical bar.
    void add_bar();
    // Returns one row for each line of the heading with the most lines, and then the row of units. The first column is
    // empty except for the word "population" in the row of units.
    std::vector<std::vector<std::string>> rows() const;

private:
    std::vector<std::vector<std::string>> columns_;  // [column][line] from the unit upwards
    std::vector<bool> is_bar_;
};

// Returns `text` with `key` in place of each `placeholder`.
std::string with_key(std::string_view text, std::string_view placeholder, std::string_view key);

// Returns the key that stands in `name` in place of the `placeholder` of `pattern`. Returns "" if there is none.
std::string_view key_in(std::string_view name, std::string_view pattern, std::string_view placeholder);

// Returns the name of a column without the unit at its end.
std::string_view without_unit(std::string_view column, std::string_view unit);

// Returns the text up to the first semicolon or full stop, without the backquotes of Markdown.
std::string first_statement(std::string_view text);

}  // namespace stopline
