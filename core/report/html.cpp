#include "report/html.h"

#include <cctype>
#include <cstdint>
#include <utility>

#include <fmt/format.h>

#include "experiment/csv.h"
#include "experiment/targets.h"

namespace stopline {

std::string html_text(std::string_view text) {
    std::string html;
    html.reserve(text.size());
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '&')
            html += "&amp;";
        else if (c == '<')
            html += "&lt;";
        else if (c == '>')
            html += "&gt;";
        else if (c == '"')
            html += "&quot;";
        else if ((byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7f)
            html += "\xEF\xBF\xBD";
        else
            html += c;
    }
    return html;
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t k = 0; k < bytes.size(); k += 3) {
        const auto byte = [&](std::size_t i) {
            return k + i < bytes.size() ? static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[k + i])) : 0U;
        };
        const std::uint32_t three = byte(0) << 16U | byte(1) << 8U | byte(2);
        for (std::size_t i = 0; i < 4; ++i) {
            text += k + i > bytes.size() ? '=' : kDigits[three >> (18U - 6U * static_cast<unsigned>(i)) & 63U];
        }
    }
    return text;
}

std::string html_id(std::string_view text) {
    std::string id;
    for (const char c : text) {
        const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
        id += plain ? c : '-';
    }
    return id;
}

HtmlTable::HtmlTable(std::string caption, std::vector<std::string> columns)
    : caption_(std::move(caption)), columns_(std::move(columns)), numbers_(columns_.size(), false) {}

void HtmlTable::row(const std::vector<Cell>& cells, const std::string& id) {
    for (std::size_t k = 0; k < cells.size() && k < numbers_.size() && rows_.empty(); ++k) {
        numbers_[k] = cells[k].css == "number";
    }
    rows_ += id.empty() ? "<tr>" : fmt::format("<tr id=\"{}\">", html_id(id));
    for (std::size_t k = 0; k < cells.size(); ++k) {
        const std::string css = cells[k].css.empty() ? "" : fmt::format(" class=\"{}\"", html_text(cells[k].css));
        const std::string label = k < columns_.size() ? html_text(columns_[k]) : "";
        rows_ += k == 0 ? fmt::format("<th scope=\"row\"{}>{}</th>", css, html_text(cells[k].text))
                        : fmt::format("<td{} data-label=\"{}\">{}</td>", css, label, html_text(cells[k].text));
    }
    rows_ += "</tr>\n";
}

std::string HtmlTable::html() const {
    std::string head;
    for (std::size_t k = 0; k < columns_.size(); ++k) {
        head +=
            fmt::format("<th scope=\"col\"{}>{}</th>", numbers_[k] ? " class=\"number\"" : "", html_text(columns_[k]));
    }
    const std::string caption = caption_.empty() ? "" : fmt::format("<caption>{}</caption>\n", html_text(caption_));
    return fmt::format("<table>\n{}<thead><tr>{}</tr></thead>\n<tbody>\n{}</tbody>\n</table>\n", caption, head, rows_);
}

std::string html_of_csv(const std::string& csv, const std::string& label) {
    const CsvTable table = parse_csv(csv, label);
    HtmlTable html("", table.columns);
    for (const std::vector<std::string>& row : table.rows) {
        std::vector<HtmlTable::Cell> cells;
        for (const std::string& text : row) cells.push_back({text, parse_number(text) ? "number" : ""});
        html.row(cells);
    }
    return html.html();
}

}  // namespace stopline
