#include "common/text_table.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace stopline {

void TextTable::add_row(std::vector<std::string> cells) { rows_.push_back(std::move(cells)); }

std::string TextTable::text(const std::string& indent) const {
    std::vector<std::size_t> widths;
    for (const std::vector<std::string>& cells : rows_) {
        widths.resize(std::max(widths.size(), cells.size()));
        for (std::size_t k = 0; k < cells.size(); ++k) widths[k] = std::max(widths[k], character_count(cells[k]));
    }
    std::string text;
    for (const std::vector<std::string>& cells : rows_) {
        std::string line = indent;
        for (std::size_t k = 0; k < cells.size(); ++k) {
            const std::string padding(widths[k] - character_count(cells[k]), ' ');
            const bool left = alignment_[std::min(k, alignment_.size() - 1)] == 'l';
            line += (k == 0 ? "" : "  ") + (left ? cells[k] + padding : padding + cells[k]);
        }
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + '\n';
    }
    return text;
}

std::string table_text(const std::vector<std::vector<std::string>>& rows) {
    TextTable table;
    for (const std::vector<std::string>& row : rows) table.add_row(row);
    return table.text();
}

std::string number_cell(double value, int decimals) {
    return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

std::string wrap_text(const std::string& text, std::size_t width, std::size_t indent) {
    std::string lines;
    std::string line;
    std::size_t begin = 0;
    while (begin < text.size()) {
        const std::size_t end = std::min(text.find(' ', begin), text.size());
        const std::string word = text.substr(begin, end - begin);
        if (!line.empty() && character_count(line) + 1 + character_count(word) > width) {
            lines += line + '\n';
            line = std::string(indent, ' ') + word;
        } else {
            line += (begin == 0 ? "" : " ") + word;
        }
        begin = end + 1;
    }
    return lines + line + '\n';
}

std::string paragraphs_text(const std::vector<std::string>& texts) {
    constexpr std::size_t kIndent = 4;
    std::string paragraphs;
    for (const std::string& text : texts) paragraphs += wrap_text(text, kConsoleWidth, kIndent);
    return paragraphs;
}

std::size_t character_count(const std::string& text) {
    return static_cast<std::size_t>(std::count_if(
        text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

}  // namespace stopline
