// Builds ids and tables in HTML.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stopline {

// Returns a value for an id attribute. Characters other than letters, digits, '-' and '_' become '-'.
std::string html_id(std::string_view text);

// A table. On a narrow screen each row becomes a block, and each cell is preceded by the name of its column.
class HtmlTable {
public:
    struct Cell {
        std::string text;      // plain text; the table escapes it
        std::string css = {};  // class of the cell; "number" aligns the cell and the column name to the right
    };

    // The caption may be empty.
    HtmlTable(std::string caption, std::vector<std::string> columns);
    void row(const std::vector<Cell>& cells, const std::string& id = "");
    std::string html() const;

private:
    std::string caption_;
    std::vector<std::string> columns_;
    std::vector<bool> numbers_;  // [column] true if the cell of the first row is a number
    std::string rows_;
};

// Returns CSV text as a table without caption. Numbers are aligned to the right. `label` names the file in error
// messages.
std::string html_of_csv(const std::string& csv, const std::string& label);

}  // namespace stopline
