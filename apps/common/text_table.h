// Aligned columns for the terminal.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace stopline {

class TextTable {
public:
    // One letter a column, l (left) or r (right); columns beyond it are like the last. The default suits a table of numbers.
    explicit TextTable(std::string alignment = "lr") : alignment_(std::move(alignment)) {}

    void row(std::vector<std::string> cells);
    // Lines that end in a line break; two spaces between columns, each as wide as its widest cell.
    std::string text(const std::string& indent = "  ") const;

private:
    std::string alignment_;
    std::vector<std::vector<std::string>> rows_;
};

// Lines of at most `width` characters, broken at spaces, all but the first indented; ends in a line break.
std::string wrapped(const std::string& text, std::size_t width, std::size_t indent);

// Characters, not bytes, of UTF-8 text.
std::size_t characters(const std::string& text);

}  // namespace stopline
