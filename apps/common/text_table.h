// A table of aligned columns for the terminal, and text wrapped to a width.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace stopline {

class TextTable {
public:
    // `alignment` has one letter per column, l (left) or r (right). The last letter applies to all further columns.
    explicit TextTable(std::string alignment = "lr") : alignment_(std::move(alignment)) {}

    void add_row(std::vector<std::string> cells);
    // Returns one line per row. A column is as wide as its widest cell; two spaces separate columns.
    std::string text(const std::string& indent = "  ") const;

private:
    std::string alignment_;
    std::vector<std::vector<std::string>> rows_;
};

// Returns the text of a TextTable with these rows.
std::string table_text(const std::vector<std::vector<std::string>>& rows);

// Returns a table cell with a number; "-" for NaN.
std::string number_cell(double value, int decimals);

// Width of texts on the console, in characters.
inline constexpr std::size_t kConsoleWidth = 100;

// Returns one paragraph for each text, wrapped to the width of the console.
std::string paragraphs_text(const std::vector<std::string>& texts);

// Returns `text` broken at spaces into lines of at most `width` characters. Each line except the first begins with
// `indent` spaces.
std::string wrap_text(const std::string& text, std::size_t width, std::size_t indent);

// Returns the number of characters, not bytes, of UTF-8 text.
std::size_t character_count(const std::string& text);

}  // namespace stopline
