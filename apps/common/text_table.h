// Aligned columns for the terminal: the first to the left, all others to the right.
#pragma once

#include <string>
#include <vector>

namespace stopline {

class TextTable {
public:
    void row(std::vector<std::string> cells);
    // Lines that end in a line break; two spaces between columns, each as wide as its widest cell.
    std::string text(const std::string& indent = "  ") const;

private:
    std::vector<std::vector<std::string>> rows_;
};

// Characters, not bytes, of UTF-8 text.
std::size_t characters(const std::string& text);

}  // namespace stopline
