// Small pieces of HTML: escaped text, tables, pictures inside the page.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace stopline {

// For text between tags and inside attributes in double quotes. Control characters that HTML forbids become U+FFFD.
std::string html_text(std::string_view text);

// RFC 4648, with padding.
std::string base64(std::string_view bytes);

// For an id attribute: what is not a letter, a digit, '-' or '_' becomes '-'.
std::string html_id(std::string_view text);

// A table whose rows turn into blocks on a narrow screen, each cell with its column's name before it.
class HtmlTable {
public:
    struct Cell {
        std::string text;      // escaped here
        std::string css = {};  // class of the cell; number: to the right, its column's name too
    };

    // `caption` is read out before the table; "": none.
    HtmlTable(std::string caption, std::vector<std::string> columns);
    void row(const std::vector<Cell>& cells, const std::string& id = "");
    std::string html() const;

private:
    std::string caption_;
    std::vector<std::string> columns_;
    std::vector<bool> numbers_;  // [column], as in the first row
    std::string rows_;
};

// A table of CSV text without a caption; numbers to the right. `label` stands for the file in messages.
std::string html_of_csv(const std::string& csv, const std::string& label);

}  // namespace stopline
