// Functions that build HTML tables and values of id attributes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stopline {

// Returns `text` as a value for an id attribute. Characters other than letters, digits, '-' and '_' become '-'.
std::string html_id(std::string_view text);

// An HTML table. On a narrow screen, the style sheet of the page shows each row as a block, with the column name in
// front of each cell.
class HtmlTable {
public:
    struct Cell {
        std::string text;      // plain text; the table escapes it
        std::string css = {};  // CSS class; "number" aligns the cell and the column name to the right
    };

    // The caption may be empty.
    HtmlTable(std::string caption, std::vector<std::string> columns);
    void row(const std::vector<Cell>& cells, const std::string& id = "");
    std::string html() const;

private:
    std::string caption_;
    std::vector<std::string> columns_;
    std::vector<bool> numbers_;  // [column] true: the cell in the first row has the CSS class "number"
    std::string rows_;
};

// Converts CSV text to an HTML table without caption. Numbers are aligned to the right. `label` names the CSV file in
// error messages.
std::string html_of_csv(const std::string& csv, const std::string& label);

}  // namespace stopline
